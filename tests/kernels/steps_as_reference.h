// Compares whole steps of an engine with the double-precision reference.
#pragma once
#include <fmt/core.h>

#include <cmath>

#include "core/names.h"
#include "reference/test_scene.h"

namespace reference {

/// Tolerance relative to the largest value of each quantity. Float: coordinates of up to 0.2 m are rounded
/// to 7e-9 m in every step. This is 1.5e-5 of an overlap of 0.5 mm, and 1.5 times as much of its power 3/2.
/// Double: the same with 1e-16, except that the kernels find the elastic sphere's overlap by a few Newton
/// steps and the reference by bisection.
inline double tolerance(Precision precision, ContactModel model) {
    if (precision == Precision::single_precision) return 5e-5;
    const bool by_newton =
        model == ContactModel::elastic_sphere || model == ContactModel::hyperelastic_sphere;
    return by_newton ? 3e-5 : 1e-12;
}

struct Differences {
    double position = 0, velocity = 0, angular_velocity = 0, force = 0, overlap = 0, point = 0,
           wall_force = 0, kinetic = 0, elastic = 0, deepest = 0;
    bool same_contacts = true;
    double worst() const {
        return std::max({position, velocity, angular_velocity, force, overlap, point, wall_force, kinetic,
                         elastic, deepest});
    }
};

/// Touching contacts, each once: with a wall, or from the grain of lower index.
inline std::vector<ReferenceContact> listed_contacts(const StepReference& reference) {
    std::vector<ReferenceContact> listed;
    for (const ReferenceContact& contact : reference.neighbours())
        if (contact.overlap > 0 && (mcdem::is_wall(contact.partner) || contact.partner > contact.grain))
            listed.push_back(contact);
    return listed;
}

inline void compare_contacts(const std::vector<mcdem::Contact>& contacts, const StepReference& reference,
                             double skim, Differences& d) {
    std::map<std::pair<int, int>, ReferenceContact> expected;
    double largest = 0;
    for (const ReferenceContact& contact : listed_contacts(reference))
        largest = std::max(largest, contact.overlap);
    for (const ReferenceContact& contact : listed_contacts(reference))
        expected[{contact.grain, contact.partner}] = contact;
    std::vector<Vec3> force, point, overlap, force_0, point_0, overlap_0;
    for (const auto& contact : contacts) {
        const auto found = expected.find({contact.grain, contact.partner});
        if (found == expected.end()) {
            d.same_contacts &= contact.overlap < skim * largest;  // may be a contact within rounding errors
            continue;
        }
        const ReferenceContact& same = found->second;
        force.push_back(contact.force);
        force_0.push_back(same.force);
        point.push_back(contact.point - reference.position[contact.grain]);
        point_0.push_back(same.arm * same.direction);
        overlap.push_back({contact.overlap, 0, 0});
        overlap_0.push_back({same.overlap, 0, 0});
        expected.erase(found);
    }
    for (const auto& [key, contact] : expected) d.same_contacts &= contact.overlap < skim * largest;
    d.force = relative_difference(force, force_0);
    d.point = relative_difference(point, point_0);
    d.overlap = relative_difference(overlap, overlap_0);
}

inline Differences compare(const Engine& engine, int r, const mcdem::IntervalResult& result,
                           const StepReference& reference, double skim) {
    Differences d;
    const auto state = engine.state(r);
    d.position = relative_difference(state.position, reference.position);
    d.velocity = relative_difference(state.velocity, reference.velocity);
    d.angular_velocity = relative_difference(state.angular_velocity, reference.angular_velocity);
    compare_contacts(state.contacts, reference, skim, d);
    const Totals totals = reference.totals();
    d.wall_force = relative_difference(wall_forces(result.wall_force), wall_forces(totals.wall_force));
    d.kinetic = relative_difference(result.kinetic_energy, totals.kinetic_energy);
    d.elastic = relative_difference(result.elastic_energy, totals.elastic_energy);
    d.deepest = relative_difference(result.deepest_overlap, totals.deepest_overlap);
    return d;
}

inline std::string text(const Differences& d) {
    return fmt::format(
        "position {:.1e} velocity {:.1e} spin {:.1e} force {:.1e} overlap {:.1e} point {:.1e} wall force "
        "{:.1e} kinetic {:.1e} elastic {:.1e} deepest {:.1e} same contacts {}",
        d.position, d.velocity, d.angular_velocity, d.force, d.overlap, d.point, d.wall_force, d.kinetic,
        d.elastic, d.deepest, d.same_contacts);
}

/// Compares six steps one by one while the plate moves down; the sixth uses the whole history of
/// displacements. `slack` multiplies the tolerance.
inline void expect_steps_as_reference(const KernelBuild& build, const std::vector<Start>& starts,
                                      unsigned seed, double slack = 1) {
    constexpr double plate_velocity = -0.05;
    Batch batch(build, starts);
    Engine& engine = batch.engine();
    Uniform uniform(seed);
    std::vector<StepReference> references;
    std::vector<double> plate;
    for (std::size_t r = 0; r < starts.size(); ++r) {
        const std::size_t count = starts[r].packing.size();
        engine.set_velocities(r, uniform.vectors(count, 0.05), uniform.vectors(count, 5));
        references.push_back(reference_of(engine, r, starts[r]));
        references[r].begin(starts[r].replica.plate.start, plate_velocity);
        plate.push_back(starts[r].replica.plate.start);
    }
    for (int step = 0; step < 6; ++step) {
        std::vector<mcdem::StepInterval> intervals;
        for (std::size_t r = 0; r < starts.size(); ++r) {
            intervals.push_back({1, plate[r], plate_velocity, 0});
            references[r].set_time_step(engine.time_step(static_cast<int>(r)));
        }
        const auto results = engine.advance(intervals);
        for (std::size_t r = 0; r < starts.size(); ++r) {
            references[r].step();
            plate[r] += plate_velocity * references[r].time_step();
            const ContactModel model = starts[r].replica.contact.model;
            const double allowed = slack * tolerance(build.precision, model);
            const Differences d = compare(engine, r, results[r], references[r], allowed);
            const std::string where = fmt::format("step {}, replica {} ({}, {} grains): {}", step, r,
                                                  name(model), starts[r].packing.size(), text(d));
            EXPECT_EQ(results[r].status, 0) << where;
            EXPECT_TRUE(d.same_contacts) << where;
            EXPECT_LT(d.worst(), allowed) << where;
        }
    }
}

inline Start start_of(ContactModel model, FrictionLaw law, int count, unsigned seed) {
    Replica replica = test_replica(model);
    replica.contact.friction_law = law;
    return jittered_lattice(replica, count, seed);
}

inline std::vector<Precision> precisions() {
    if (has_double()) return {Precision::single_precision, Precision::double_precision};
    return {Precision::single_precision};
}

}  // namespace reference
