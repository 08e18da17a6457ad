// Compares steps of an engine with the double-precision reference.
#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "sim/engine.h"
#include "sim/reference/sample.h"
#include "sim/reference/step_reference.h"

namespace mcdem::reference {

/// The reference of one replica, with the engine's (rounded) state.
StepReference reference_of(const Engine& engine, int r, const Start& start);

/// Largest distance between vectors of two sets over the largest vector of the second set; infinite if the
/// sets differ in size.
double relative_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b);
double relative_difference(double a, double b);

inline std::vector<Vec3> wall_forces(const std::array<Vec3, 6>& forces) {
    return {forces.begin(), forces.end()};
}

/// Tolerance relative to the largest value of each quantity. Float: coordinates of up to 0.2 m are rounded
/// to 7e-9 m in every step. This is 1.5e-5 of an overlap of 0.5 mm, and 1.5 times as much of its power 3/2.
/// Double: the same with 1e-16, except that the kernels find the elastic sphere's overlap by a few Newton
/// steps and the reference by bisection.
double tolerance(Precision precision, ContactModel model);

struct Differences {
    double position = 0, velocity = 0, angular_velocity = 0, force = 0, overlap = 0, point = 0,
           wall_force = 0, kinetic = 0, elastic = 0, deepest = 0;
    bool same_contacts = true;
    double worst() const;  ///< the largest one; not-a-number if one is
};

std::string text(const Differences& d);

/// A contact that exists on one side only counts if its overlap exceeds `skim` times the largest one; a
/// smaller one may exist by rounding errors.
Differences compare(const ReplicaState& state, const IntervalResult& result, const StepReference& reference,
                    double skim);

/// Makes six steps of an engine and of the reference, one by one, while the plate moves down; the sixth uses
/// the whole history of displacements. Calls see(step, replica, result, differences) after each, from step
/// `first_seen` on. `slack` multiplies the tolerance by which contacts may differ.
using SeeStep = std::function<void(int step, std::size_t replica, const IntervalResult& result,
                                   const Differences& differences)>;
void compare_steps(Device& device, const KernelBuild& build, const std::vector<Start>& starts, unsigned seed,
                   double slack, int first_seen, const SeeStep& see);

}  // namespace mcdem::reference
