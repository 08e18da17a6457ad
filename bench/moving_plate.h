// A batch of dense packings under a plate that moves down and up at the speed of the paper, for the step
// benchmarks. The engine rebuilds neighbour lists when necessary.
#pragma once
#include "bench/dense_packing.h"
#include "sim/engine.h"

namespace mcdem::bench {

struct StepCase {
    ContactModel model = ContactModel::mc_dem;
    FrictionLaw friction = FrictionLaw::saturated;
    int grains = 514;  ///< per replica
    int replicas = 1;
    Precision precision = Precision::single_precision;
};

class MovingPlate {
public:
    /// Every replica is the dense packing of that many grains, jittered by the measurement error of the
    /// experiment, and relaxed briefly.
    MovingPlate(Device& device, const StepCase& wanted, const std::filesystem::path& cache);

    /// Steps of one round: half of them while the plate moves down, half while it moves up.
    static constexpr int round_steps = 120;

    /// Runs one round of every replica. Throws RunError if a replica stops.
    void round();

    double coordination_number() const;  ///< Z of the first replica
    double top_force() const {
        return top_force_;
    }  ///< on the first replica's plate at the last round's end [N]
    double time_step() const { return engine_.time_step(0); }
    double bytes_per_grain() const;
    const StepCase& what() const { return case_; }

private:
    MovingPlate(Device& device, const StepCase& wanted, const DensePacking& dense);
    void make_steps(int steps, double plate_velocity, double settle_drag);

    StepCase case_;
    std::vector<double> plate_z_;  ///< of each replica [m]
    Engine engine_;
    double top_force_ = 0;
};

/// Throws RunError unless the packing has the expected density, nothing has failed, and the top force of one
/// packing of 514 grains agrees with that in double precision (if the device supports it).
void check_before_timing(Device& device, MovingPlate& subject, const std::filesystem::path& cache);

}  // namespace mcdem::bench
