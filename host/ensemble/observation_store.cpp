#include "ensemble/observation_store.h"

#include <cstdint>
#include <fstream>

#include "core/atomic_file.h"
#include "core/make_folder.h"
#include "core/sha256.h"
#include "io/results.h"

namespace mcdem {
namespace {

/// A digest of the numbers comes first: a file damaged later is not believed.
std::string digest_of(const Eigen::VectorXd& values) {
    return Sha256().add(std::span(values.data(), static_cast<std::size_t>(values.size()))).hex();
}

}  // namespace

ObservationStore::ObservationStore(std::filesystem::path folder) : folder_(std::move(folder)) {
    make_folder(folder_);
}

std::filesystem::path ObservationStore::file_of(const std::string& name) const {
    return folder_ / (name + ".obs");
}

std::optional<Eigen::VectorXd> ObservationStore::find(const std::string& name) const {
    std::ifstream in(file_of(name), std::ios::binary | std::ios::ate);
    constexpr std::streamoff digest_length = 64;
    const std::streamoff size = in ? static_cast<std::streamoff>(in.tellg()) - digest_length : -1;
    if (size < 0 || size % static_cast<std::streamoff>(sizeof(double))) return std::nullopt;
    std::string digest(digest_length, ' ');
    Eigen::VectorXd values(size / static_cast<std::streamoff>(sizeof(double)));
    in.seekg(0);
    in.read(digest.data(), digest_length);
    in.read(reinterpret_cast<char*>(values.data()), size);
    return in && digest == digest_of(values) ? std::optional(values) : std::nullopt;
}

void ObservationStore::keep(const std::string& name, const Eigen::VectorXd& observation) const {
    std::string bytes = digest_of(observation);
    bytes.append(reinterpret_cast<const char*>(observation.data()),
                 static_cast<std::size_t>(observation.size()) * sizeof(double));
    replace_file(file_of(name), bytes);
}

std::filesystem::path ObservationStore::recording_file(const std::string& name) const {
    return folder_ / (name + ".h5");
}

bool ObservationStore::has_recording(const std::string& name) const {
    return std::filesystem::exists(recording_file(name));
}

Recording ObservationStore::recording(const std::string& name) const {
    return read_run(recording_file(name)).recordings.at(0);
}

void ObservationStore::keep(const std::string& name, const Recording& recording) const {
    Run run;
    run.name = name;
    run.recordings = {recording};
    write_run(recording_file(name), run);
}

}  // namespace mcdem
