// Reads any four files as an experiment folder: it is read and checked, or refused with an InputError. The
// files are concatenated, separated by lines "%%%": experiment.toml, plate.csv, grains.csv, contacts.csv.
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "core/errors.h"
#include "experiment/check_experiment.h"

namespace {

/// One folder per process, in memory if the system supports it.
const std::filesystem::path& folder() {
    static const std::filesystem::path path = [] {
        const std::filesystem::path memory = "/dev/shm";
        const auto made =
            (std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path()) /
            ("mcdem-fuzz-" + std::to_string(getpid()));
        std::filesystem::create_directories(made);
        std::atexit([] { std::filesystem::remove_all(folder()); });
        return made;
    }();
    return path;
}

void write_files(std::string_view text) {
    constexpr std::string_view parting = "%%%\n";
    for (const char* name : {"experiment.toml", "plate.csv", "grains.csv", "contacts.csv"}) {
        std::filesystem::remove(folder() / name);
        if (text.empty()) continue;
        const auto end = text.find(parting);
        std::ofstream(folder() / name, std::ios::binary) << text.substr(0, end);
        text = end == text.npos ? std::string_view() : text.substr(end + parting.size());
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    write_files({reinterpret_cast<const char*>(bytes), size});
    try {
        check_experiment(mcdem::read_experiment(folder()));
    } catch (const mcdem::InputError&) {
    }
    return 0;
}
