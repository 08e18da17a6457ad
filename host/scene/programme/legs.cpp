#include "scene/programme/legs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/container.h"
#include "core/errors.h"

namespace mcdem::inline scene {

double turning_point(const Stage& stage, int cycle) {
    const double first = !std::isnan(stage.force)    ? stage.force
                         : !std::isnan(stage.strain) ? stage.strain
                                                     : stage.position;
    return cycle == 0 ? first : stage.back + (first - stage.back) * (1 + stage.growth * cycle);
}

std::vector<Stage> stages_of(const Replica& replica) {
    if (!replica.programme.empty()) return replica.programme;
    Stage strokes;
    strokes.kind = StageKind::cycle;
    strokes.position = replica.plate.end;
    strokes.back = replica.plate.start;
    strokes.cycles = replica.protocol.cycles;
    strokes.scans = replica.protocol.scans_per_stroke;
    return {strokes};
}

void expect_plate(const Scene& scene, const std::string& what) {
    for (const Replica& replica : scene.replicas) {
        if (is_cell(replica.box))
            throw InputError(fmt::format(
                "container.shape: must be one with a plate for {}, got cell: it compares strokes of a "
                "plate",
                what));
        if (!replica.species.empty())
            throw InputError(fmt::format(
                "species: must be left out of a scene for {}, which supports one material only", what));
    }
}

void expect_plain_strokes(const Scene& scene, const std::string& what) {
    expect_plate(scene, what);
    for (const Replica& replica : scene.replicas)
        if (!replica.programme.empty())
            throw InputError(
                fmt::format("programme: must be left out of a scene for {}, which compares the strokes of "
                            "[plate] and [protocol] only",
                            what));
}

SetStress set_stress(const Stage& stage) {
    if (stage.kind != StageKind::move) return no_stress;
    SetStress set{stage.stress_x,  stage.stress_y,  stage.stress_z,
                  stage.stress_xy, stage.stress_xz, stage.stress_yz};
    if (!std::isnan(stage.pressure)) std::fill_n(set.begin(), 3, stage.pressure);
    return set;
}

bool sets_stress(const Stage& stage) {
    return std::ranges::any_of(set_stress(stage), [](double stress) { return !std::isnan(stress); });
}

Controlled controlled(const Stage& stage) {
    if (stage.kind == StageKind::hold) return stage.keep;
    if (sets_stress(stage)) return Controlled::stress;
    return std::isnan(stage.force) ? Controlled::position : Controlled::force;
}

double in_si(const Stage& stage, double value, const Plate& plate) {
    const bool strain = controlled(stage) == Controlled::position && !std::isnan(stage.strain);
    return strain ? plate.start * (1 - value) : value;
}

int scans_of(const Stage& stage) {
    return stage.scan_at.empty() ? stage.scans : static_cast<int>(stage.scan_at.size());
}

double scan_level(const Stage& stage, int number, double from, double target, const Plate& plate) {
    if (!stage.scan_at.empty()) return in_si(stage, stage.scan_at[number - 1], plate);
    return from + (target - from) * number / stage.scans;
}

double scan_time(const Stage& stage, int number) {
    return stage.scan_at.empty() ? stage.time * number / stage.scans : stage.scan_at[number - 1];
}

std::vector<Leg> legs_of(const std::vector<Stage>& stages, const Plate& plate) {
    std::vector<Leg> all;
    std::vector<std::size_t> begin;  // of each stage in `all`
    for (std::size_t n = 0; n < stages.size(); ++n) {
        const Stage& stage = stages[n];
        const int number = static_cast<int>(n);
        begin.push_back(all.size());
        if (stage.kind == StageKind::hold) all.push_back({number});
        if (stage.kind == StageKind::move) all.push_back({number, in_si(stage, turning_point(stage), plate)});
        for (int cycle = 0; stage.kind == StageKind::cycle && cycle < stage.cycles; ++cycle) {
            all.push_back({number, in_si(stage, turning_point(stage, cycle), plate)});
            all.push_back({number, in_si(stage, stage.back, plate)});
        }
        if (stage.kind != StageKind::repeat) continue;
        const std::vector<Leg> once(
            all.begin() + static_cast<long>(begin[n - static_cast<std::size_t>(stage.stages)]), all.end());
        for (int time = 1; time < stage.times; ++time) all.insert(all.end(), once.begin(), once.end());
    }
    return all;
}

double sum_over_legs(const std::vector<Stage>& stages, const std::function<double(const Stage&)>& of_stage) {
    std::vector<double> sums;
    for (std::size_t n = 0; n < stages.size(); ++n) {
        const Stage& stage = stages[n];
        double sum = of_stage(stage);
        if (stage.kind == StageKind::cycle) sum *= 2.0 * stage.cycles;
        if (stage.kind == StageKind::repeat) {
            sum = 0;
            for (int back = 1; back <= stage.stages && back <= static_cast<int>(n); ++back)
                sum += (stage.times - 1) * sums[n - static_cast<std::size_t>(back)];
        }
        sums.push_back(sum);
    }
    double all = 0;
    for (const double sum : sums) all += sum;
    return all;
}

double leg_count(const std::vector<Stage>& stages) {
    return sum_over_legs(stages, [](const Stage&) { return 1.0; });
}

double scan_count(const std::vector<Stage>& stages) {
    return sum_over_legs(stages, [](const Stage& stage) { return 1.0 * scans_of(stage); });
}

}  // namespace mcdem::scene
