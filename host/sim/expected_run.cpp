#include "sim/expected_run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/container.h"
#include "scene/packing/generate_packing.h"
#include "scene/programme/cell_path.h"
#include "scene/programme/legs.h"
#include "scene/read/resolve_species.h"

namespace mcdem::inline sim {
namespace {

/// Largest change of a strain in a move of the cell.
double max_strain_of_move(const Replica& replica) {
    double low = 0, high = 0;
    for (const Stage& stage : replica.programme)
        for (const double strain : strain_after(stage, {}))
            low = std::min(low, strain), high = std::max(high, strain);
    return high - low;
}

/// Of the walls at the sides [1/m].
double side_area_over_volume(const Box& box) {
    if (is_periodic(box)) return 0;
    return is_cylinder(box) ? 2 / cylinder_radius(box) : 2 / box.size_x + 2 / box.size_y;
}

double max_speed(const Stage& stage, const Replica& replica) {
    return std::isnan(stage.speed) ? replica.plate.speed : stage.speed;
}

/// The time that a plate needs from one position to another. Its speed follows from the lower estimate of the
/// pressure, and above the grains it is the highest.
class PlateTimes {
public:
    PlateTimes(const Replica& replica, const PackingScale& scale, double speed)
        : from_(replica.plate.end), step_((replica.plate.start - replica.plate.end) / (parts - 1)) {
        const QuasiStatic quasi_static(replica, scale);
        for (int n = 1; n < parts; ++n) {
            const double z = from_ + (n - 0.5) * step_;
            const double pressure =
                std::max(quasi_static.min_pressure(), expected_pressure(replica, scale, z).low);
            const double now = z > scale.top ? speed : quasi_static.speed(speed, z, pressure);
            until_[n] = until_[n - 1] + step_ / now;
        }
    }

    double between(double a, double b) const { return std::abs(until(a) - until(b)); }

private:
    static constexpr int parts = 64;
    double until(double z) const {
        const double at = step_ > 0 ? std::clamp((z - from_) / step_, 0.0, parts - 1.0) : 0;
        const int n = std::min(static_cast<int>(at), parts - 2);
        return until_[n] + (at - n) * (until_[n + 1] - until_[n]);
    }
    double from_, step_;
    std::array<double, parts> until_{};
};

/// Seconds of all legs of a plate. Where a force is prescribed, the way to it is unknown: at most the whole
/// range.
double seconds_of_plate(const Replica& replica, const PackingScale& scale, double& lowest) {
    const auto stages = stages_of(replica);
    std::vector<PlateTimes> times;
    for (const Stage& stage : stages) times.emplace_back(replica, scale, max_speed(stage, replica));
    double seconds = 0, position = replica.plate.start;
    for (const Leg& leg : legs_of(stages, replica.plate)) {
        const auto n = static_cast<std::size_t>(leg.stage);
        if (stages[n].kind == StageKind::hold) {
            seconds += stages[n].time;
            continue;
        }
        const bool is_known = controlled(stages[n]) == Controlled::position;
        const double target = is_known ? leg.target : replica.plate.end;
        seconds += times[n].between(is_known ? position : replica.plate.start, target);
        position = target;
        lowest = std::min(lowest, position);
    }
    return seconds;
}

}  // namespace

double seconds_of_stage(const Stage& stage, const Replica& replica) {
    if (stage.kind == StageKind::hold) return stage.time;
    if (!is_cell(replica.box))
        return std::abs(replica.plate.start - replica.plate.end) / max_speed(stage, replica);
    const double most = max_strain_of_move(replica);
    return (sets_stress(stage) ? std::max(1.0, most) : most) / stage.rate;
}

PressureRange expected_pressure(const Replica& replica, const PackingScale& scale, double z) {
    const double fraction = scale.volume / (floor_area(replica.box) * z);
    const double at_walls = 1 - 0.107 * scale.diameter * (2 / z + side_area_over_volume(replica.box));
    const auto affine = [&](double start, double neighbours) {
        const double strain =
            std::max(0.0, 1 - start * at_walls / fraction) / 3;  // overlap over the diameter
        const double force = 4.0 / 3 * (scale.modulus / 2) * 0.5 * std::pow(strain, 1.5);  // over d^2
        return fraction * neighbours * force / std::numbers::pi;
    };
    const double others = replica.contact.model == ContactModel::independent ? 1 : 2;
    return {affine(0.64, 6), 1.5 * others * affine(0.58, 8)};
}

ExpectedRun expected_run(const Replica& replica, const PackingScale& scale, double time_step) {
    const Protocol& protocol = replica.protocol;
    const auto stages = stages_of(replica);
    ExpectedRun run;
    run.relax_steps = protocol.relax_time / time_step;
    run.lowest = replica.plate.start;
    double seconds = 0;
    if (is_cell(replica.box)) {
        seconds = sum_over_legs(stages, [&](const Stage& stage) { return seconds_of_stage(stage, replica); });
    } else {
        seconds = seconds_of_plate(replica, scale, run.lowest);
        run.at_lowest = expected_pressure(replica, scale, run.lowest);
    }
    if (protocol.stop_at_scans)
        seconds += scan_count(stages) * (protocol.pause > 0 ? protocol.pause : protocol.settle_time);
    run.programme_steps = std::max(1.0, seconds / time_step);
    return run;
}

PackingScale expected_scale(const Replica& replica) {
    if (const auto* file = std::get_if<PackingFile>(&replica.packing.source))
        return scale_of(replica, file->read());
    const auto& wanted = std::get<GeneratedPacking>(replica.packing.source);
    auto [packing, height] = draw_grains(wanted, replica.box, replica.packing.seed, mixture_of(replica));
    for (const double diameter : packing.diameter) packing.position.emplace_back(0, 0, height - diameter / 2);
    return scale_of(replica, packing);
}

}  // namespace mcdem::sim
