#include "bench/moving_plate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/errors.h"
#include "scene/packing/make_packing.h"

namespace mcdem::bench {
namespace {

constexpr int slots = 16;
constexpr double plate_speed = 0.1;      // [m/s], as in the paper
constexpr double position_error = 1e-4;  // [m], of the experiment
constexpr int relax_steps = 60;
constexpr double relax_drag = 100;  // [1/s]
/// About six contacts per grain; the range allows for displaced surfaces.
constexpr double min_contacts = 5, max_contacts = 8;
/// Tolerance of the top force in float compared with double, after a round.
constexpr double precision_tolerance = 1e-3;

std::vector<Replica> replicas_of(const StepCase& wanted, const DensePacking& dense) {
    Replica replica;
    replica.box = dense.box;
    replica.contact.model = wanted.model;
    replica.contact.friction_law = wanted.friction;
    replica.plate.start = dense.height;
    replica.plate.speed = plate_speed;
    return std::vector<Replica>(wanted.replicas, replica);
}

std::vector<Packing> packings_of(const StepCase& wanted, const DensePacking& dense) {
    std::vector<Packing> packings(wanted.replicas, dense.packing);
    for (int r = 0; r < wanted.replicas; ++r) apply_jitter(packings[r], position_error, r + 1);
    return packings;
}

/// Top force of 514 grains after a round with the same steps in double precision.
double reference_top_force(Device& device, const StepCase& like, const std::filesystem::path& cache) {
    static std::map<std::pair<ContactModel, FrictionLaw>, double> known;
    const auto [entry, is_new] = known.try_emplace({like.model, like.friction}, 0.0);
    if (is_new) {
        MovingPlate exact(device, {like.model, like.friction, 514, 1, Precision::double_precision}, cache);
        exact.round();
        entry->second = exact.top_force();
    }
    return entry->second;
}

}  // namespace

MovingPlate::MovingPlate(Device& device, const StepCase& wanted, const std::filesystem::path& cache)
    : MovingPlate(device, wanted, dense_packing(wanted.grains, cache)) {}

MovingPlate::MovingPlate(Device& device, const StepCase& wanted, const DensePacking& dense)
    : case_(wanted),
      plate_z_(wanted.replicas, dense.height),
      engine_(device, kernel_build(device, wanted.precision, slots), replicas_of(wanted, dense),
              packings_of(wanted, dense)) {
    make_steps(relax_steps, 0, relax_drag);
}

void MovingPlate::round() {
    make_steps(round_steps / 2, -plate_speed, 0);
    make_steps(round_steps / 2, plate_speed, 0);
}

/// Replicas whose lists must be rebuilt make fewer steps than requested, so each counts its own.
void MovingPlate::make_steps(int steps, double plate_velocity, double settle_drag) {
    const int replicas = engine_.replicas();
    std::vector<int> left(replicas, steps);
    while (std::ranges::any_of(left, [](int n) { return n > 0; })) {
        std::vector<StepInterval> intervals(replicas);
        for (int r = 0; r < replicas; ++r)
            intervals[r] = {std::min(left[r], engine_.max_interval(r, {.plate_velocity = plate_velocity})),
                            plate_z_[r], plate_velocity, settle_drag};
        const auto results = engine_.advance(intervals);
        for (int r = 0; r < replicas; ++r) {
            if (intervals[r].steps == 0) continue;
            if (results[r].status)
                throw RunError(fmt::format("replica {} stopped with status {} at grain {}", r,
                                           results[r].status, results[r].failed_grain));
            left[r] -= results[r].steps;
            plate_z_[r] += plate_velocity * engine_.time_step(r) * results[r].steps;
        }
        if (intervals[0].steps > 0) top_force_ = results[0].wall_force[static_cast<int>(Wall::plate)].z();
    }
}

double MovingPlate::coordination_number() const {
    double ends = 0;
    for (const Contact& contact : engine_.state(0).contacts) ends += is_wall(contact.partner) ? 1 : 2;
    return ends / case_.grains;
}

double MovingPlate::bytes_per_grain() const {
    return static_cast<double>(engine_.memory().all) / (static_cast<double>(case_.grains) * case_.replicas);
}

void check_before_timing(Device& device, MovingPlate& subject, const std::filesystem::path& cache) {
    subject.round();
    const double z = subject.coordination_number();
    if (!(z > min_contacts && z < max_contacts))
        throw RunError(fmt::format("Z must be between {} and {}, got {}", min_contacts, max_contacts, z));
    if (!device.info().double_precision) return;
    StepCase small = subject.what();
    small.grains = 514;
    small.replicas = 1;
    MovingPlate tested(device, small, cache);
    tested.round();
    const double exact = reference_top_force(device, small, cache);
    if (!(std::abs(tested.top_force() - exact) < precision_tolerance * exact))
        throw RunError(fmt::format("top force of 514 grains must be {} N within {}, got {}", exact,
                                   precision_tolerance, tested.top_force()));
}

}  // namespace mcdem::bench
