// A batch of dense packings under a plate that goes down and up at the paper's speed: what the step
// benchmarks run. Neighbour lists are made anew as the engine sees need.
#pragma once
#include "bench/dense_packing.h"
#include "sim/engine.h"

namespace mcdem::bench {

struct StepCase {
    ContactModel model = ContactModel::mc_dem;
    FrictionLaw friction = FrictionLaw::saturated;
    int grains = 514;  ///< a replica
    int replicas = 1;
    Precision precision = Precision::single_precision;
};

class MovingPlate {
public:
    /// Every replica is the dense packing of that many grains, jittered by the experiment's measurement
    /// error, and relaxed for a moment.
    MovingPlate(Device& device, const StepCase& wanted, const std::filesystem::path& cache);

    /// Steps of one round: the plate goes down for half of them and up for the other half.
    static constexpr int round_steps = 120;

    /// One round of every replica. Throws RunError when a replica stops.
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

/// Throws RunError unless the packing is as dense as it should be, nothing has failed, and the top force of
/// one packing of 514 grains agrees with the same in double precision (where the device has it).
void check_before_timing(Device& device, MovingPlate& subject, const std::filesystem::path& cache);

}  // namespace mcdem::bench
