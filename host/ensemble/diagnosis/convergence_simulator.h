// Simulations of one scene with changed numerics, observed as in a diagnosis: what the study of its
// convergence compares.
#pragma once
#include <filesystem>
#include <map>
#include <string>

#include "ensemble/diagnosis/observe_trials.h"

namespace mcdem::inline ensemble {

/// Copies of the packing of a scene's first replica. Simulations are stored, so that none is repeated.
class ConvergenceSimulator {
public:
    /// `jitter`: standard deviation of every initial coordinate [m]; 0: half a per cent of a diameter.
    /// `program`: version and commit.
    ConvergenceSimulator(const Scene& scene, const std::filesystem::path& folder, int replicas, double jitter,
                         std::uint64_t seed, std::string program, const std::string& device);

    const Device& device() const { return device_; }
    const Grid& grid() const { return grid_; }

    /// Finds the displacements that are compared: those of a diagnosis of an experiment with this scene's
    /// stroke or programme. The first copy is simulated if there is a programme. Throws InputError if that
    /// stops.
    void find_grid(const Callbacks& callbacks);

    /// The scene with these values of keys. Row: copy, column: bin of the grid; NaN if a simulation failed.
    Eigen::MatrixXd observe(const std::map<std::string, std::string>& values, const Callbacks& callbacks);

    /// Whether the packing is generated, so that there are others of its kind.
    bool draws_packings() const;
    /// From now on every copy has its own random packing.
    void draw_packings(const StopWanted& stop_wanted);

private:
    std::vector<Trial> trials_of(const Replica& replica, double jitter) const;
    TrialSettings settings_of(const Scene& scene, const Model& model) const;

    Device device_;
    Scene scene_;  ///< with one replica
    ObservationStore store_;
    double jitter_;
    std::uint64_t seed_;
    std::string program_;
    std::vector<Packing> packings_;  ///< by copy
    double mean_diameter_ = 0;
    Grid grid_;
};

}  // namespace mcdem::ensemble
