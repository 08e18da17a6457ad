// Checks of the stages of a programme.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/container.h"
#include "scene/programme/legs.h"
#include "scene/programme/scan_quantity.h"
#include "scene/read/scene_checks.h"

namespace mcdem::inline scene {
namespace {

/// Contacts may be stiffer than Hertz's law by this factor because of displaced surfaces, stiffening or
/// finite strain.
constexpr double beyond_hertz = 10;

/// Force on the plate [N] above which the contacts under it would exceed numerics.overlap_limit.
double max_plate_force(const Settings& settings) {
    const auto& replica = settings.replica;
    const double radius = settings.generated.diameter_min / 2;
    const double grains = std::max(1.0, replica.box.size_x * replica.box.size_y / (3.4 * radius * radius));
    const double modulus = plane_modulus(stiffest(replica));
    const double overlap = std::min(1.0, replica.numerics.overlap_limit) * 2 * radius;
    return beyond_hertz * grains * 4 / 3 * modulus * std::sqrt(radius) * std::pow(overlap, 1.5);
}

/// The same for the stress of a cell [Pa].
double max_cell_stress(const Settings& settings) {
    const auto& replica = settings.replica;
    const double radius = settings.generated.diameter_min / 2;
    const double overlap = std::min(1.0, replica.numerics.overlap_limit) * 2 * radius;
    const double force =
        4.0 / 3 * plane_modulus(stiffest(replica)) / 2 * std::sqrt(radius / 2) * std::pow(overlap, 1.5);
    return beyond_hertz * force / (2 * std::sqrt(3.0) * radius * radius);
}

/// Whether a kind of stage has a key; all have `stage`.
bool belongs(StageKind kind, std::string_view key, bool cell) {
    const auto any = [&](std::initializer_list<std::string_view> list) {
        return std::ranges::find(list, key) != list.end();
    };
    if (cell && kind == StageKind::move)
        return any({"stage", "strain", "strain_x", "strain_y", "strain_z", "shear_xy", "shear_xz", "shear_yz",
                    "pressure", "stress_x", "stress_y", "stress_z", "stress_xy", "stress_xz", "stress_yz",
                    "rate", "scans", "scan_at"});
    if (cell && kind == StageKind::hold) return any({"stage", "keep", "time", "scans", "scan_at"});
    switch (kind) {
        case StageKind::move:
            return any({"stage", "position", "strain", "force", "speed", "scans", "scan_at"});
        case StageKind::hold:
            return any({"stage", "keep", "time", "scans", "scan_at"});
        case StageKind::cycle:
            return any(
                {"stage", "position", "strain", "force", "back", "cycles", "growth", "speed", "scans"});
        case StageKind::repeat:
            return any({"stage", "stages", "times"});
    }
    return false;
}

/// One stage and its problems.
class StageChecks {
public:
    StageChecks(const Settings& settings, int number, const std::set<std::string>& said,
                std::vector<CrossProblem>& problems)
        : is_cell_(is_cell(settings.replica.box)),
          plate_(settings.replica.plate),
          stage_(settings.replica.programme[number]),
          number_(number),
          said_(said),
          problems_(problems) {}

    void check() {
        if (is_cell_ && stage_.kind == StageKind::cycle)
            return add("stage",
                       "must be move, hold or repeat in a cell, got cycle: take a move there, a move back "
                       "and a repeat of both");
        for (const Key& key : stage_keys(number_)) {
            const std::string_view field = key.name.substr(key.name.rfind('.') + 1);
            if (said_.contains(std::string(key.name)) && !belongs(stage_.kind, field, is_cell_))
                add(field, fmt::format("must be left out of a stage that is a {} of {}", name(stage_.kind),
                                       is_cell_ ? "a cell" : "the plate"));
        }
        if (said("scans") && said("scan_at")) add("scan_at", "must be left out where scans is given");
        if (stage_.kind == StageKind::hold) check_hold();
        if (stage_.kind == StageKind::move && is_cell_) return check_move_of_cell();
        if (stage_.kind == StageKind::move || stage_.kind == StageKind::cycle) check_target();
        if (stage_.kind == StageKind::repeat && stage_.stages > number_)
            add("stages", fmt::format("must be at most the {} before it, got {}", number_, stage_.stages));
    }

private:
    bool said(std::string_view field) const {
        return said_.contains(fmt::format("programme.{}.{}", number_ + 1, field));
    }
    void add(std::string_view field, std::string what) {
        problems_.push_back({fmt::format("programme.{}.{}", number_ + 1, field), std::move(what)});
    }

    void check_hold() {
        if (std::isnan(stage_.time)) add("time", "must be given: a hold has no other end");
        check_kept();
        for (std::size_t k = 0; k < stage_.scan_at.size(); ++k) {
            const double at = stage_.scan_at[k], before = k ? stage_.scan_at[k - 1] : 0;
            if (!(at > before && !(at > stage_.time)))
                return add("scan_at",
                           fmt::format("must be growing times > 0 and <= time = {}, got {} after {}",
                                       stage_.time, at, before));
        }
    }

    void check_kept() {
        if (stage_.keep == Controlled::position) return;
        const Controlled other = is_cell_ ? Controlled::stress : Controlled::force;
        if (stage_.keep != other)
            return add("keep", fmt::format("must be position or {} in a hold of {}, got {}", name(other),
                                           is_cell_ ? "a cell" : "the plate", name(stage_.keep)));
        if (number_ == 0)
            return add("keep",
                       fmt::format("must be position in the first stage: no {} is there yet to be held",
                                   name(other)));
    }

    void check_move_of_cell() {
        const std::array<std::string_view, 3> strains{"strain_x", "strain_y", "strain_z"},
            stresses{"stress_x", "stress_y", "stress_z"}, shears{"shear_xy", "shear_xz", "shear_yz"},
            shear_stresses{"stress_xy", "stress_xz", "stress_yz"};
        const std::string_view others[]{"strain", "pressure"};
        const auto is_said = [&](auto field) { return said(field); };
        if (std::ranges::none_of(strains, is_said) && std::ranges::none_of(stresses, is_said) &&
            std::ranges::none_of(shears, is_said) && std::ranges::none_of(shear_stresses, is_said) &&
            std::ranges::none_of(others, is_said))
            add("strain",
                "must be given, or strain_x, shear_xy, pressure, stress_x, ..: a move of a cell "
                "needs one of them");
        for (const std::string_view all : {"strain", "pressure"})
            for (std::size_t axis = 0; said(all) && axis < 3; ++axis)
                for (const std::string_view field : {strains[axis], stresses[axis]})
                    if (said(field)) add(field, fmt::format("must be left out where {} is given", all));
        if (said("strain") && said("pressure")) add("pressure", either("strain"));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (said(strains[axis]) && said(stresses[axis])) add(stresses[axis], either(strains[axis]));
            if (said(shears[axis]) && said(shear_stresses[axis]))
                add(shear_stresses[axis], either(shears[axis]));
        }
        if (stage_.strain > 0.99)
            add("strain", fmt::format("must leave a cell some volume, at most 0.99, got {}", stage_.strain));
    }
    static std::string either(std::string_view strain) {
        return fmt::format("must be left out where {} is given: a direction has a strain or a stress",
                           strain);
    }

    void check_target() {
        std::vector<std::string_view> given;
        for (const std::string_view field : {"position", "strain", "force"})
            if (said(field)) given.push_back(field);
        if (given.empty())
            return add("position", fmt::format("must be given, or strain or force: a {} needs one of them",
                                               name(stage_.kind)));
        for (std::size_t k = 1; k < given.size(); ++k)
            add(given[k], fmt::format("must be left out where {} is given", given.front()));
        if (given.size() > 1) return;
        const std::string_view field = given.front();
        const double target = turning_point(stage_);
        expect_possible(field, field, target);
        if (stage_.kind == StageKind::cycle) check_cycle(field, target);
        check_scan_places(field, target);
    }

    /// Checks a position (between plate.end and plate.start) or a force.
    void expect_possible(std::string_view at, std::string_view field, double value) {
        if (field == "force") {
            if (!(value > 0)) add(at, fmt::format("must be a force > 0 [N], got {}", value));
            return;
        }
        const double z = in_si(stage_, value, plate_), rounding = 1e-12 * plate_.start;
        if (z > plate_.start + rounding || z < plate_.end - rounding)
            add(at, fmt::format("must keep the plate between plate.end = {} and plate.start = {}, got {}{}",
                                plate_.end, plate_.start, value,
                                field == "strain" ? fmt::format(", that is {:.6g} m", z) : ""));
    }

    void check_cycle(std::string_view field, double target) {
        if (!said("back"))
            return add("back", fmt::format("must be given: the {} that a cycle returns to", field));
        expect_possible("back", field, stage_.back);
        if (stage_.back == target)
            add("back", fmt::format("must differ from {}, got {} for both", field, target));
        const double last = 1 + stage_.growth * (stage_.cycles - 1);
        if (!(last > 0))
            return add("growth",
                       fmt::format("must leave the last of {} cycles an amplitude, got {}: at least {:.6g}",
                                   stage_.cycles, stage_.growth, -1.0 / (stage_.cycles - 1)));
        if (stage_.growth != 0) expect_possible("growth", field, turning_point(stage_, stage_.cycles - 1));
    }

    void check_scan_places(std::string_view field, double target) {
        const auto& at = stage_.scan_at;
        for (const double value : at) expect_possible("scan_at", field, value);
        const bool up = !at.empty() && target > at.front();
        for (std::size_t k = 0; k < at.size(); ++k) {
            const double next = k + 1 < at.size() ? at[k + 1] : target;
            const bool last = k + 1 == at.size();
            if (last && next == at[k]) continue;
            if (next == at[k] || (next > at[k]) != up)
                return add(
                    "scan_at",
                    fmt::format("must be places on the way to {} = {}, one after the other, got {} before {}",
                                field, target, at[k], next));
        }
    }

    bool is_cell_;
    const Plate& plate_;
    const Stage& stage_;
    int number_;
    const std::set<std::string>& said_;
    std::vector<CrossProblem>& problems_;
};

std::vector<double> forces_of(const Stage& stage) {
    if (stage.kind == StageKind::hold || stage.kind == StageKind::repeat || std::isnan(stage.force))
        return {};
    std::vector<double> forces{stage.force};
    if (stage.kind == StageKind::cycle) forces.push_back(turning_point(stage, stage.cycles - 1));
    return forces;
}

void check_forces(const Settings& settings, std::vector<CrossProblem>& problems) {
    if (!settings.packing_file.empty()) return;
    const double max_force = max_plate_force(settings);
    for (std::size_t n = 0; n < settings.replica.programme.size(); ++n)
        for (const double force : forces_of(settings.replica.programme[n]))
            if (force > max_force)
                problems.push_back(
                    {fmt::format("programme.{}.force", n + 1),
                     fmt::format("must be one that the grains can bear, got {}: beyond some {:.3g} N the "
                                 "contacts under the plate are deeper than numerics.overlap_limit = {}",
                                 force, max_force, settings.replica.numerics.overlap_limit)});
}

void check_stresses(const Settings& settings, std::vector<CrossProblem>& problems) {
    if (!settings.packing_file.empty()) return;
    const double max_stress = max_cell_stress(settings);
    for (std::size_t n = 0; n < settings.replica.programme.size(); ++n) {
        const Stage& stage = settings.replica.programme[n];
        const SetStress stress = set_stress(stage);
        for (std::size_t axis = 0; axis < stress.size(); ++axis) {
            const bool all = axis < 3 && !std::isnan(stage.pressure);
            if (!(std::abs(stress[axis]) > max_stress) || (all && axis > 0)) continue;
            const std::string field = all ? "pressure" : fmt::format("stress_{}", axis_names[axis]);
            problems.push_back(
                {fmt::format("programme.{}.{}", n + 1, field),
                 fmt::format(
                     "must be one that the grains can bear, got {}: beyond some {:.3g} Pa their contacts "
                     "are deeper than numerics.overlap_limit = {}",
                     stress[axis], max_stress, settings.replica.numerics.overlap_limit)});
        }
    }
}

void check_size(const std::vector<Stage>& programme, std::vector<CrossProblem>& problems) {
    if (const double legs = leg_count(programme); legs > max_legs)
        problems.push_back({"programme.1.stage",
                            fmt::format("and the others must be at most {} moves and holds in all, got {}",
                                        max_legs, legs)});
    const double scans = scan_count(programme);
    if (scans > max_scans || scans == 0)
        problems.push_back(
            {"programme.1.scans",
             fmt::format("and the others must leave 1 to {} scans in all, got {}", max_scans, scans)});
}

/// A hold of stresses keeps those set by the previous move, also if stages are repeated.
void check_kept_stresses(const std::vector<Stage>& programme, const Plate& plate,
                         std::vector<CrossProblem>& problems) {
    const Stage* move = nullptr;
    for (const Leg& leg : legs_of(programme, plate)) {
        const Stage& stage = programme[leg.stage];
        if (stage.kind != StageKind::hold) {
            move = &stage;
        } else if (stage.keep == Controlled::stress && !(move && sets_stress(*move))) {
            problems.push_back({fmt::format("programme.{}.keep", leg.stage + 1),
                                "must be position where the move before sets no stress: set those to be held "
                                "there (pressure, or stress_x, ..)"});
            return;
        }
    }
}

}  // namespace

std::vector<CrossProblem> programme_problems(const Settings& settings, const std::set<std::string>& said,
                                             const std::set<std::string, std::less<>>& bad) {
    std::vector<CrossProblem> problems;
    const auto& programme = settings.replica.programme;
    if (programme.empty()) {
        const bool tried = std::ranges::any_of(said, [](const auto& key) { return stage_of(key) >= 0; });
        if (is_cell(settings.replica.box) && !tried)
            problems.push_back(
                {"container.shape",
                 "must come with a [[programme]] where it is cell: nothing else deforms a cell"});
        return problems;
    }
    for (const char* key : {"protocol.cycles", "protocol.scans_per_stroke", "protocol.discard"})
        if (said.contains(key)) problems.push_back({key, "must be left out where a programme is given"});
    bool any_bad = bad.contains("plate.start") || bad.contains("plate.end");
    for (std::size_t n = 0; n < programme.size(); ++n) {
        const auto keys = stage_keys(static_cast<int>(n));
        if (std::ranges::any_of(keys, [&](const Key& key) { return bad.contains(key.name); })) {
            any_bad = true;
        } else if (std::ranges::none_of(
                       keys, [&](const Key& key) { return said.contains(std::string(key.name)); })) {
            problems.push_back({fmt::format("programme.{}.stage", n + 1),
                                fmt::format("must be given too: there is a stage {}", programme.size())});
        } else {
            StageChecks(settings, static_cast<int>(n), said, problems).check();
        }
    }
    if (any_bad || !problems.empty()) return problems;
    check_forces(settings, problems);
    check_stresses(settings, problems);
    check_size(programme, problems);
    if (!problems.empty()) return problems;
    check_kept_stresses(programme, settings.replica.plate, problems);
    if (is_cell(settings.replica.box))
        for (const auto& [stage, problem] : scan_at_problems(programme, settings.replica.plate))
            problems.push_back({fmt::format("programme.{}.scan_at", stage + 1), problem});
    return problems;
}

}  // namespace mcdem::scene
