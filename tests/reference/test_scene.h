// Shared by the tests of kernels and simulation: the device, generated packings, an engine with its scene,
// and the comparison of an engine with the reference.
#pragma once
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstring>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "cl/program.h"
#include "sim/reference/comparison.h"

namespace mcdem::reference {

/// The device selected by MCDEM_DEVICE; one per process.
inline mcdem::Device& device() {
    static mcdem::Device the_device;
    return the_device;
}

inline KernelBuild build(Precision precision, int slots = 16) {
    return mcdem::kernel_build(device(), precision, slots);
}

/// CPUs run both layouts. GPUs run only their own: their compilers need minutes for vectors of 16 numbers.
inline bool has_other_way() { return !device().info().gpu; }

/// The kernel build with the GPU layout, on a CPU. Check has_other_way() first.
inline KernelBuild other_way(KernelBuild build) {
    build.lanes = build.lanes > 1 ? 1 : 16;
    return build;
}

/// The kernel builds with all layouts that the device runs.
inline std::vector<KernelBuild> all_ways(const KernelBuild& build) {
    if (!has_other_way()) return {build};
    return {build, other_way(build)};
}

#define SKIP_WITHOUT_OTHER_WAY() \
    if (!has_other_way()) GTEST_SKIP() << "GPUs do not use the layout of CPUs"

/// NVIDIA's compiler fuses products and sums differently in the kernels for one and for several materials, so
/// the last bits of a replica depend on whether any other in its batch has several.
inline bool fuses_alike() { return device().info().platform.find("NVIDIA") == std::string::npos; }

inline bool has_double() { return device().info().double_precision; }

/// `layers` of a square lattice with random offsets, whose grains also overlap across the periodic sides.
/// Some grains are in other images of the cell.
inline Start periodic_lattice(Replica replica, int side, int layers, unsigned seed) {
    constexpr double spacing = 0.019;
    Uniform uniform(seed);
    Packing packing;
    for (int i = 0; i < side * side * layers; ++i) {
        const Vec3 site(i % side, i / side % side, i / (side * side));
        packing.position.push_back(spacing * (site + Vec3(-0.3, 0.1, 0.5)) + uniform.vector(3e-4));
        packing.diameter.push_back(0.02 * uniform(0.95, 1.05));
        if (i % 5 == 1) packing.position.back().x() += 2 * side * spacing;
        if (i % 7 == 2) packing.position.back().y() -= side * spacing;
    }
    replica.box = {side * spacing, side * spacing, mcdem::ContainerShape::periodic};
    replica.plate.start = layers * spacing;
    replica.plate.end = 0.9 * replica.plate.start;
    return {replica, packing};
}

/// A cubic lattice with random offsets, `side` grains along each edge, periodic in all directions.
inline Start cell_lattice(Replica replica, int side, unsigned seed) {
    Start start = periodic_lattice(replica, side, side, seed);
    start.replica.grains.excess_density = 0;
    start.replica.box.shape = mcdem::ContainerShape::cell;
    start.replica.box.height = start.replica.plate.start;
    start.replica.plate.end = 0;
    for (std::size_t i = 0; i < start.packing.size(); ++i)
        if (i % 4 == 3) start.packing.position[i].z() -= start.replica.box.height;
    return start;
}

/// `layers` of two rings of grains in a cylinder of 40 mm radius; the outer ring touches the wall.
inline Start rings_in_a_cylinder(Replica replica, int layers, unsigned seed) {
    constexpr double radius = 0.04, spacing = 0.019;
    Uniform uniform(seed);
    Packing packing;
    for (int layer = 0; layer < layers; ++layer)
        for (const auto& [ring, count] : {std::pair(radius - 0.0095, 10), std::pair(radius - 0.0285, 3)})
            for (int i = 0; i < count; ++i) {
                const double angle = (i + 0.5 * layer) * 2 * std::numbers::pi / count;
                packing.position.push_back(Vec3(radius + ring * std::cos(angle),
                                                radius + ring * std::sin(angle), spacing * (layer + 0.5)) +
                                           uniform.vector(3e-4));
                packing.diameter.push_back(0.02 * uniform(0.95, 1.05));
            }
    replica.box = {2 * radius, 2 * radius, mcdem::ContainerShape::cylinder};
    replica.plate.start = layers * spacing;
    replica.plate.end = 0.9 * replica.plate.start;
    return {replica, packing};
}

/// Grains in the middle of a box that is so large that no grain touches a wall.
inline Start free_cluster(Replica replica, std::vector<Vec3> position, std::vector<double> diameter) {
    constexpr double box = 1;
    for (auto& x : position) x += Vec3::Constant(box / 2);
    replica.box = {box, box};
    replica.plate.start = box;
    replica.plate.end = box / 2;
    return {replica, {std::move(position), std::move(diameter)}};
}

/// A sphere and its twelve neighbours in a face-centred cubic crystal; neighbours are `distance` apart.
inline std::vector<Vec3> thirteen(double distance) {
    const double h = distance / std::sqrt(2.0);
    std::vector<Vec3> all{Vec3::Zero()};
    for (double a : {h, -h})
        for (double b : {h, -h}) all.insert(all.end(), {Vec3(a, b, 0), Vec3(a, 0, b), Vec3(0, a, b)});
    return all;
}

/// Thirteen free grains of about 10 mm radius that overlap by about 5 %, with random offsets.
inline Start irregular_cluster(Replica replica, unsigned seed) {
    Uniform uniform(seed);
    auto position = thirteen(0.019);
    std::vector<double> diameter;
    for (auto& x : position) {
        x += uniform.vector(3e-4);
        diameter.push_back(0.02 * uniform(0.95, 1.05));
    }
    replica.grains.drag = 0;
    replica.grains.excess_density = 0;
    return free_cluster(replica, position, diameter);
}

/// Thirteen equal grains confined by six walls; `compression` is every overlap over the sum of radii.
inline Start caged_cluster(Replica replica, double compression, double jitter, unsigned seed) {
    constexpr double radius = 0.01;
    Uniform uniform(seed);
    const double distance = 2 * radius * (1 - compression);
    const double half = distance / std::sqrt(2.0) + radius * (1 - compression);
    Packing packing;
    for (const Vec3& x : thirteen(distance)) {
        packing.position.push_back(x + Vec3::Constant(half) + uniform.vector(jitter));
        packing.diameter.push_back(2 * radius);
    }
    replica.box = {2 * half, 2 * half};
    replica.plate.start = 2 * half;
    replica.plate.end = 1.9 * half;
    return {replica, packing};
}

/// One grain of 10 mm radius in the middle of a box with rigid walls without friction, at these distances
/// from the centre over the radius.
inline Start held_grain(ContactModel model, double poisson_ratio, double restitution,
                        const Vec3& half_width) {
    constexpr double radius = 0.01;
    Replica replica;
    replica.grains = {1e5, poisson_ratio, 1000, 0, 0, restitution, 0};
    replica.walls = {1e13, 0.5, 0, restitution};
    replica.contact.model = model;
    replica.contact.gamma = 1.125;
    replica.numerics.probe_gap = 0.3;
    replica.box = {2 * radius * half_width.x(), 2 * radius * half_width.y()};
    replica.plate.start = 2 * radius * half_width.z();
    return {replica, {{radius * half_width}, {2 * radius}}};
}

inline Precision finest() { return has_double() ? Precision::double_precision : Precision::single_precision; }

/// The replicas or the packings of several starts.
template <class Member>
std::vector<Member> each(const std::vector<Start>& starts, Member Start::*member) {
    std::vector<Member> all;
    for (const Start& start : starts) all.push_back(start.*member);
    return all;
}

/// An engine with several replicas; the plates are at rest at plate.start.
class Batch {
public:
    Batch(const KernelBuild& build, const std::vector<Start>& starts)
        : engine_(device(), build, each(starts, &Start::replica), each(starts, &Start::packing)),
          starts_(starts) {}
    explicit Batch(const KernelBuild& build, const Start& start) : Batch(build, std::vector<Start>{start}) {}

    Engine& engine() { return engine_; }
    const Start& start(int replica = 0) const { return starts_[replica]; }

    /// Advances every replica by `steps`, in as many intervals as necessary. Returns the last results.
    std::vector<mcdem::IntervalResult> advance(int steps, double settle_drag = 0) {
        std::vector<int> left(starts_.size(), steps);
        std::vector<mcdem::IntervalResult> last(starts_.size());
        for (bool any = steps > 0; any;) {
            std::vector<mcdem::StepInterval> intervals;
            for (std::size_t r = 0; r < starts_.size(); ++r)
                intervals.push_back({std::min(left[r], 60), starts_[r].replica.plate.start, 0, settle_drag});
            const auto results = engine_.advance(intervals);
            any = false;
            for (std::size_t r = 0; r < starts_.size(); ++r) {
                if (left[r] == 0) continue;
                last[r] = results[r];
                left[r] = results[r].status ? 0 : left[r] - results[r].steps;
                any |= left[r] > 0;
            }
        }
        return last;
    }

private:
    Engine engine_;
    std::vector<Start> starts_;
};

/// True if all bits are equal.
inline bool same_bits(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3)) == 0);
}

inline bool same_bits(const mcdem::ReplicaState& a, const mcdem::ReplicaState& b) {
    const auto forces = [](const mcdem::ReplicaState& state) {
        std::vector<Vec3> all;
        for (const auto& contact : state.contacts)
            all.insert(all.end(),
                       {contact.force, contact.point, Vec3(contact.grain, contact.partner, contact.overlap)});
        return all;
    };
    return same_bits(a.position, b.position) && same_bits(a.velocity, b.velocity) &&
           same_bits(a.angular_velocity, b.angular_velocity) && same_bits(forces(a), forces(b));
}

}  // namespace mcdem::reference
