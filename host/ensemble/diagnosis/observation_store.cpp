#include "ensemble/diagnosis/observation_store.h"

#include <algorithm>

#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/input_file.h"
#include "core/look.h"
#include "core/make_folder.h"
#include "core/sha256.h"
#include "io/results.h"

namespace mcdem::inline ensemble {
namespace {

/// A digest of the numbers is stored first, to detect damaged files.
std::string digest_of(const Eigen::VectorXd& values) {
    return Sha256().add(std::span(values.data(), static_cast<std::size_t>(values.size()))).hex();
}

}  // namespace

std::optional<Eigen::VectorXd> read_observation(const std::filesystem::path& file) {
    constexpr std::size_t digest_length = 64;
    if (!is_there(file)) return std::nullopt;
    const std::string bytes = read_file(file);
    if (bytes.size() < digest_length || (bytes.size() - digest_length) % sizeof(double) != 0)
        return std::nullopt;
    Eigen::VectorXd values(static_cast<Eigen::Index>((bytes.size() - digest_length) / sizeof(double)));
    std::copy(bytes.begin() + digest_length, bytes.end(), reinterpret_cast<char*>(values.data()));
    if (bytes.substr(0, digest_length) != digest_of(values)) return std::nullopt;
    return values;
}

ObservationStore::ObservationStore(std::filesystem::path folder) : folder_(std::move(folder)) {
    make_folder(folder_);
}

std::filesystem::path ObservationStore::file_of(const std::string& name) const {
    return folder_ / (name + ".obs");
}

std::optional<Eigen::VectorXd> ObservationStore::find(const std::string& name) const {
    return read_observation(file_of(name));
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
    if (!is_there(recording_file(name))) return false;
    try {
        return recording(name).diameter.size() > 0;
    } catch (const InputError&) {
        return false;
    }
}

Recording ObservationStore::recording(const std::string& name) const {
    Run run = read_run(recording_file(name));
    if (run.recordings.empty()) throw InputError(recording_file(name).string() + ": holds no recording");
    return std::move(run.recordings.front());
}

void ObservationStore::keep(const std::string& name, const Recording& recording) const {
    Run run;
    run.name = name;
    run.recordings = {recording};
    write_run(recording_file(name), run);
}

}  // namespace mcdem::ensemble
