// Observations of simulations, and a few whole recordings, kept under a name made of all that went into them,
// so that nothing is simulated twice.
#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>

#include "core/recording.h"

namespace mcdem::inline ensemble {

class ObservationStore {
public:
    /// Makes the folder where it is missing.
    explicit ObservationStore(std::filesystem::path folder);
    /// What was kept under the name; nothing where it is missing or damaged.
    std::optional<Eigen::VectorXd> find(const std::string& name) const;
    void keep(const std::string& name, const Eigen::VectorXd& observation) const;

    /// One that is whole.
    bool has_recording(const std::string& name) const;
    /// Throws InputError where it is missing or damaged.
    Recording recording(const std::string& name) const;
    void keep(const std::string& name, const Recording& recording) const;

private:
    std::filesystem::path file_of(const std::string& name) const;
    std::filesystem::path recording_file(const std::string& name) const;
    std::filesystem::path folder_;
};

}  // namespace mcdem::ensemble
