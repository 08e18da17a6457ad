// Observations of simulations, kept under a name made of all that went into them, so that nothing is simulated twice.
#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>

namespace mcdem {

class ObservationStore {
public:
    /// Makes the folder where it is missing.
    explicit ObservationStore(std::filesystem::path folder);
    /// What was kept under the name; nothing where it is missing or damaged.
    std::optional<Eigen::VectorXd> find(const std::string& name) const;
    void keep(const std::string& name, const Eigen::VectorXd& observation) const;

private:
    std::filesystem::path file_of(const std::string& name) const;
    std::filesystem::path folder_;
};

}  // namespace mcdem
