#include "sim/simulation.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "core/container.h"
#include "core/errors.h"
#include "core/expects.h"
#include "scene/packing/make_packing.h"
#include "scene/packing/true_grains.h"
#include "sim/averages.h"
#include "sim/batch_limits.h"
#include "sim/device_replica.h"
#include "sim/failure_causes.h"

namespace mcdem::inline sim {
namespace {

/// Grains whose states are read together: about 500 MB.
constexpr std::size_t max_grains_held = std::size_t{1} << 20;

std::vector<Packing> true_packings(const std::vector<Replica>& replicas, std::vector<Packing> stated) {
    for (std::size_t r = 0; r < stated.size(); ++r)
        stated[r] = true_packing(replicas[r], std::move(stated[r]));
    for (std::size_t r = 0; r < stated.size(); ++r) {
        expect_room(replicas[r], stated[r]);
        expect_slow_grains(replicas[r], size_of(stated[r]), time_step(replicas[r], stated[r]));
    }
    return stated;
}

/// Wraps grains, and the points of their contacts with them.
void bring_into_cell(const Box& now, Scan& scan) {
    std::vector<Vec3> moved;
    for (Vec3& position : scan.position) {
        const Vec3 inside = into_cell(now, position);
        moved.push_back(inside - position);
        position = inside;
    }
    for (Contact& contact : scan.contacts) contact.point += moved[static_cast<std::size_t>(contact.grain)];
}

}  // namespace

Simulation::Simulation(Device& device, const Scene& scene, std::vector<Packing> packings)
    : scene_(scene),
      diameter_([&] {
          std::vector<std::vector<double>> all;
          for (const auto& packing : packings) all.push_back(packing.diameter);
          return all;
      }()),
      scale_([&] {
          std::vector<PackingScale> all;
          for (std::size_t r = 0; r < packings.size(); ++r)
              all.push_back(scale_of(scene.replicas[r], packings[r]));
          return all;
      }()),
      engine_(device, kernel_build(device, scene.precision, scene.slots), scene.replicas,
              true_packings(scene.replicas, std::move(packings))) {
    for (int r = 0; r < engine_.replicas(); ++r) {
        expect_countable_steps(scene_.replicas[r], engine_.time_step(r));
        runners_.emplace_back(scene_.replicas[r], engine_.time_step(r), scale_[static_cast<std::size_t>(r)]);
        plates_.emplace_back(scene_.replicas[r]);
        budgets_.emplace_back(scene_.replicas[r], scale_[static_cast<std::size_t>(r)]);
    }
}

std::vector<StepInterval> Simulation::next_intervals() {
    std::vector<StepInterval> intervals;
    for (int r = 0; r < engine_.replicas(); ++r) {
        runners_[r].set_time_step(engine_.time_step(r));
        intervals.push_back(
            runners_[r].next([&](const StepInterval& next) { return engine_.max_interval(r, next); }));
        plates_[r].deflect(intervals[r], engine_.time_step(r, intervals[r]), engine_.max_plate_move(r));
    }
    return intervals;
}

bool Simulation::advance(const ScanSink& on_scan, const FailureSink& on_failure) {
    const auto intervals = next_intervals();
    const bool any = std::ranges::any_of(intervals, [](const auto& next) { return next.steps > 0; });
    if (any) engine_.begin_interval(intervals);
    pass_on(on_scan, on_failure);
    if (!any) return false;
    const auto results = engine_.finish_interval();
    std::size_t grains_due = 0;
    std::vector<int> due;
    const auto read = [&] { reading_count_ = engine_.begin_reading(std::exchange(due, {}), readings_); };
    for (int r = 0; r < engine_.replicas(); ++r) {
        grain_steps_ += static_cast<long>(results[r].steps) * static_cast<long>(diameter_[r].size());
        if (intervals[r].steps == 0 || runners_[r].finished()) continue;  // pass_on() may have ended it
        if (!take_note(r, results[r])) continue;
        due.push_back(r);
        grains_due += diameter_[r].size();
        if (grains_due < max_grains_held) continue;
        read();
        pass_on(on_scan, on_failure);
        grains_due = 0;
    }
    read();
    return true;
}

bool Simulation::take_note(int replica, const IntervalResult& result) {
    auto& runner = runners_[replica];
    const bool relaxes = runner.state().activity == Activity::relax;
    const Protocol& protocol = scene_.replicas[replica].protocol;
    // Only a strong drag tells whether grains are at rest.
    const bool stops = runner.state().activity == Activity::settle && protocol.stop_at_scans &&
                       protocol.pause == 0 && protocol.settle_drag > 0;
    plates_[replica].on_interval_done(result);
    budgets_[replica].add(result);
    Outcome outcome{replica, result, budgets_[replica].terms(), {}, {}};
    if (budgets_[replica].verdict() == EnergyBudget::Verdict::creates_energy && engine_.shorten(replica))
        budgets_[replica].correct();
    outcome.scan = runner.on_interval_done(result, plates_[replica].arrived(engine_.max_plate_move(replica)));
    std::string broken = created_energy(budgets_[replica]);
    if (broken.empty() && stops && outcome.scan && outcome.scan->settled &&
        !is_cell(scene_.replicas[replica].box))
        broken = imbalance(result, scale_[replica].weight);
    if (result.status || !broken.empty()) {
        outcome.scan.reset();
        outcome.failure =
            result.status ? failure(replica, result, relaxes) : Failure{runner.state().step, -1, broken};
        runner.stop();
    } else if (!runner.hindrance().empty()) {
        outcome.failure = Failure{runner.state().step, -1, runner.hindrance()};
    }
    if (outcome.scan || outcome.failure) outcomes_.push_back(outcome);
    return outcome.scan.has_value();
}

void Simulation::pass_on(const ScanSink& on_scan, const FailureSink& on_failure) {
    fill_scans();
    reading_count_ = 0;
    auto next = scans_.begin();
    for (Outcome& outcome : std::exchange(outcomes_, {})) {
        const int r = outcome.replica;
        if (outcome.scan) {
            const std::string beyond = beyond_law(scene_.replicas[r], *next);
            if (!beyond.empty()) outcome.failure = Failure{runners_[r].state().step, -1, beyond};
            on_scan(r, *next++);
        }
        if (!outcome.failure) continue;
        on_failure(r, *outcome.failure);
        runners_[r].stop();
    }
}

void Simulation::fill_scans() {
    std::vector<const Outcome*> with_scan;
    for (const Outcome& outcome : outcomes_)
        if (outcome.scan) with_scan.push_back(&outcome);
    scans_.resize(std::max(scans_.size(), with_scan.size()));
    engine_.for_each_state(
        std::span(readings_).first(reading_count_),
        [&](std::size_t i, int, const Readings& read) { fill_scan(*with_scan[i], read, scans_[i]); });
}

void Simulation::fill_scan(const Outcome& outcome, const Readings& read, Scan& scan) const {
    const auto& [replica, result, energy, tag, _] = outcome;
    scan.frame = tag->frame;
    scan.cycle = tag->cycle;
    scan.phase = tag->phase;
    scan.time = tag->time;
    const auto& spec = scene_.replicas[replica];
    scan.strain = runners_[replica].strain();
    scan.plate_z = is_cell(spec.box) ? deformed(spec.box, scan.strain).height : tag->plate_z;
    scan.settled = tag->settled;
    scan.rate_error = tag->rate_error;
    scan.wall_force = result.wall_force;
    scan.kinetic_energy = result.kinetic_energy;
    scan.elastic_energy = result.elastic_energy;
    scan.wall_work = energy.wall_work;
    scan.weight_work = energy.weight_work;
    scan.damping_loss = energy.damping_loss;
    scan.friction_loss = energy.friction_loss;
    scan.drag_loss = energy.drag_loss;
    scan.energy_error = energy.energy_error;
    engine_.take_state(replica, read, scan);
    if (is_cell(spec.box)) bring_into_cell(deformed(spec.box, scan.strain), scan);
    fill_averages(scan, spec.box, diameter_[replica], spec.protocol.force_threshold);
    if (!scene_.output.positions) scan.position.clear(), scan.rotation.clear();
    if (!scene_.output.contacts) scan.contacts.clear();
}

Failure Simulation::failure(int replica, const IntervalResult& result, bool relaxes) const {
    const std::string created = created_energy(budgets_[static_cast<std::size_t>(replica)]);
    return {runners_[replica].state().step, result.failed_grain,
            created.empty() ? cause_of(result, scene_.replicas[replica], scene_.slots, relaxes) : created};
}

double Simulation::progress() const {
    double sum = 0;
    for (const auto& runner : runners_) sum += runner.progress();
    return sum / runners_.size();
}

std::map<std::string, std::vector<std::byte>> Simulation::save() {
    expects(outcomes_.empty(), "scans and failures of the last interval are passed on");
    auto saved = engine_.save();
    const auto keep = [&](const char* name, const auto& parts) {
        auto& bytes = saved[name];
        for (const auto& part : parts) {
            const auto* begin = reinterpret_cast<const std::byte*>(&part.state());
            bytes.insert(bytes.end(), begin, begin + sizeof part.state());
        }
    };
    keep("protocol", runners_);
    keep("plates", plates_);
    keep("budgets", budgets_);
    return saved;
}

void Simulation::restore(const std::map<std::string, std::vector<std::byte>>& saved) {
    outcomes_.clear();
    reading_count_ = 0;
    engine_.restore(saved);
    const auto bring_back = [&](const char* name, auto& parts) {
        auto state = parts.front().state();
        const auto found = saved.find(name);
        if (found == saved.end() || found->second.size() != parts.size() * sizeof state)
            throw RunError(
                "the checkpoint does not belong to this scene: it holds another number of replicas");
        for (std::size_t r = 0; r < parts.size(); ++r) {
            std::memcpy(&state, found->second.data() + r * sizeof state, sizeof state);
            if (!parts[r].is_possible(state))
                refuse_checkpoint("it holds an invalid state of the plate's programme");
            parts[r].set_state(state);
        }
    };
    bring_back("protocol", runners_);
    bring_back("plates", plates_);
    bring_back("budgets", budgets_);
}

Recording begin_recording(const Replica& replica, const Packing& packing) {
    Recording recording;
    recording.label = replica.label;
    recording.parameters = replica.parameters;
    recording.box = replica.box;
    recording.plate_start = replica.plate.start;
    recording.diameter = packing.diameter;
    recording.species = packing.species;
    for (const Species& species : replica.species) recording.species_names.push_back(species.name);
    return recording;
}

}  // namespace mcdem::sim
