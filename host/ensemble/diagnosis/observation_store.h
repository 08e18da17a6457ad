// Stores observations of simulations, and a few complete recordings, under hashes of all their inputs, so
// that no simulation is repeated.
#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>

#include "core/recording.h"

namespace mcdem::inline ensemble {

/// Returns the observation in a file of a store; empty where it is missing or damaged.
std::optional<Eigen::VectorXd> read_observation(const std::filesystem::path& file);

class ObservationStore {
public:
    /// Creates the folder if necessary.
    explicit ObservationStore(std::filesystem::path folder);
    /// The stored observation with this name; nothing if it is missing or damaged.
    std::optional<Eigen::VectorXd> find(const std::string& name) const;
    void keep(const std::string& name, const Eigen::VectorXd& observation) const;

    /// Whether there is an undamaged one.
    bool has_recording(const std::string& name) const;
    /// Throws InputError if it is missing or damaged.
    Recording recording(const std::string& name) const;
    void keep(const std::string& name, const Recording& recording) const;

private:
    std::filesystem::path file_of(const std::string& name) const;
    std::filesystem::path recording_file(const std::string& name) const;
    std::filesystem::path folder_;
};

}  // namespace mcdem::ensemble
