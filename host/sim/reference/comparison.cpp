#include "sim/reference/comparison.h"

#include <fmt/core.h>

#include <cmath>
#include <limits>

namespace mcdem::reference {
namespace {

/// The larger one; not-a-number if one of them is.
double larger(double a, double b) { return std::isnan(a) || a >= b ? a : b; }

/// Touching contacts, each once: with a wall, or from the grain of lower index.
std::vector<ReferenceContact> listed_contacts(const StepReference& reference) {
    std::vector<ReferenceContact> listed;
    for (const ReferenceContact& contact : reference.neighbours())
        if (contact.overlap > 0 && (is_wall(contact.partner) || contact.partner > contact.grain))
            listed.push_back(contact);
    return listed;
}

void compare_contacts(const std::vector<Contact>& contacts, const StepReference& reference, double skim,
                      Differences& d) {
    std::map<std::pair<int, int>, ReferenceContact> expected;
    double largest = 0;
    for (const ReferenceContact& contact : listed_contacts(reference)) {
        largest = std::max(largest, contact.overlap);
        expected[{contact.grain, contact.partner}] = contact;
    }
    std::vector<Vec3> force, point, overlap, force_0, point_0, overlap_0;
    for (const auto& contact : contacts) {
        const auto found = expected.find({contact.grain, contact.partner});
        if (found == expected.end()) {
            d.same_contacts &= contact.overlap < skim * largest;
            continue;
        }
        const ReferenceContact& same = found->second;
        force.push_back(contact.force);
        force_0.push_back(same.force);
        point.push_back(contact.point - reference.position[static_cast<std::size_t>(contact.grain)]);
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

}  // namespace

StepReference reference_of(const Engine& engine, int r, const Start& start) {
    StepReference reference(start.replica, start.packing);
    if (engine.precision() == Precision::single_precision) reference.set_radius_slack(0x1p-11);
    const auto state = engine.state(r);
    reference.position = state.position;
    reference.velocity = state.velocity;
    reference.angular_velocity = state.angular_velocity;
    reference.list_neighbours();
    return reference;
}

double relative_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
    double size = 0, difference = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        size = std::max(size, b[i].norm());
        difference = larger(difference, (a[i] - b[i]).norm());
    }
    return difference == 0 ? 0 : difference / size;
}

double relative_difference(double a, double b) { return a == b ? 0 : std::abs(a - b) / std::abs(b); }

double tolerance(Precision precision, ContactModel model) {
    if (precision == Precision::single_precision) return 5e-5;
    const bool by_newton =
        model == ContactModel::elastic_sphere || model == ContactModel::hyperelastic_sphere;
    return by_newton ? 3e-5 : 1e-12;
}

double Differences::worst() const {
    double worst = 0;
    for (const double d :
         {position, velocity, angular_velocity, force, overlap, point, wall_force, kinetic, elastic, deepest})
        worst = larger(worst, d);
    return worst;
}

std::string text(const Differences& d) {
    return fmt::format(
        "position {:.1e} velocity {:.1e} spin {:.1e} force {:.1e} overlap {:.1e} point {:.1e} wall force "
        "{:.1e} kinetic {:.1e} elastic {:.1e} deepest {:.1e} same contacts {}",
        d.position, d.velocity, d.angular_velocity, d.force, d.overlap, d.point, d.wall_force, d.kinetic,
        d.elastic, d.deepest, d.same_contacts);
}

Differences compare(const ReplicaState& state, const IntervalResult& result, const StepReference& reference,
                    double skim) {
    Differences d;
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

void compare_steps(Device& device, const KernelBuild& build, const std::vector<Start>& starts, unsigned seed,
                   double slack, int first_seen, const SeeStep& see) {
    constexpr double plate_velocity = -0.05;
    std::vector<Replica> replicas;
    std::vector<Packing> packings;
    std::vector<double> plate;
    for (const Start& start : starts) {
        replicas.push_back(start.replica);
        packings.push_back(start.packing);
        plate.push_back(start.replica.plate.start);
    }
    Engine engine(device, build, replicas, packings);
    Uniform uniform(seed);
    std::vector<StepReference> references;
    for (std::size_t r = 0; r < starts.size(); ++r) {
        const std::size_t count = starts[r].packing.size();
        const int replica = static_cast<int>(r);
        engine.set_velocities(replica, uniform.vectors(count, 0.05), uniform.vectors(count, 5));
        references.push_back(reference_of(engine, replica, starts[r]));
        references[r].begin(plate[r], plate_velocity);
    }
    for (int step = 0; step < 6; ++step) {
        std::vector<StepInterval> intervals;
        for (std::size_t r = 0; r < starts.size(); ++r) {
            intervals.push_back({1, plate[r], plate_velocity, 0});
            references[r].set_time_step(engine.time_step(static_cast<int>(r)));
        }
        const auto results = engine.advance(intervals);
        for (std::size_t r = 0; r < starts.size(); ++r) {
            references[r].step();
            plate[r] += plate_velocity * references[r].time_step();
            if (step < first_seen) continue;
            const double allowed = slack * tolerance(build.precision, starts[r].replica.contact.model);
            see(step, r, results[r],
                compare(engine.state(static_cast<int>(r)), results[r], references[r], allowed));
        }
    }
}

}  // namespace mcdem::reference
