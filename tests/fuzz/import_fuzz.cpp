// Any three files as the tables of a laboratory or of another program: an import comes out or an InputError;
// and the mapping of every guess can be read, once its question marks are gone. The files stand one after the
// other, parted by lines that are "%%%".
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "core/errors.h"
#include "experiment/import_experiment.h"

namespace {

/// One folder a process, in memory where the system has such a place.
const std::filesystem::path& folder() {
    static const std::filesystem::path path = [] {
        const std::filesystem::path memory = "/dev/shm";
        const auto made =
            (std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path()) /
            ("mcdem-fuzz-import-" + std::to_string(getpid()));
        std::filesystem::create_directories(made);
        std::atexit([] { std::filesystem::remove_all(folder()); });
        return made;
    }();
    return path;
}

std::vector<std::string> write_files(std::string_view text) {
    constexpr std::string_view parting = "%%%\n";
    std::vector<std::string> files;
    while (!text.empty() && files.size() < 3) {
        const auto end = text.find(parting);
        files.push_back((folder() / std::to_string(files.size())).string());
        std::ofstream(files.back(), std::ios::binary) << text.substr(0, end);
        text = end == text.npos ? std::string_view() : text.substr(end + parting.size());
    }
    return files;
}

/// Everything confirmed as it was guessed.
mcdem::Mapping confirmed(mcdem::Mapping mapping) {
    for (mcdem::MappedTable& table : mapping.tables) {
        table.role_sure = mcdem::Sure::likely;
        table.decimal_unclear.clear();
        for (auto* guesses : {&table.entries, &table.walls})
            for (auto& [key, guess] : *guesses) guess.sure = mcdem::Sure::likely;
    }
    return mapping;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    mcdem::Experiment known;
    known.materials["grains.youngs_modulus"] = 23300;
    known.recording.box = {0.04, 0.03};
    known.recording.plate_start = 0.03;
    std::vector<mcdem::ImportTable> tables;
    try {
        tables = guess_tables(write_files({reinterpret_cast<const char*>(bytes), size}), known);
    } catch (const mcdem::InputError&) {
        return 0;
    }
    if (tables.empty()) return 0;
    const std::string text = mapping_text(confirmed(mapping_of(tables)));
    try {
        mcdem::parse_mapping(text, "mapping.toml");
    } catch (const mcdem::InputError& error) {
        std::fprintf(stderr, "%s\n%s\n", error.what(), text.c_str());
        std::abort();
    }
    try {
        import_tables(tables, known);
    } catch (const mcdem::InputError&) {
    }
    return 0;
}
