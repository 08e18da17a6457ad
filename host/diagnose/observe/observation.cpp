#include "diagnose/observe/observation.h"

#include <algorithm>
#include <cmath>

#include "scene/programme/programme_text.h"

namespace mcdem::inline diagnose {
namespace {

constexpr double parts_of_stroke[] = {0.42, 0.61, 0.80, 0.98};
constexpr double width_of_stroke = 0.12;
constexpr Phase phases[] = {Phase::load, Phase::unload};

/// Weighted straight lines through the observables of several scans, evaluated at the centre.
class LocalLine {
public:
    explicit LocalLine(Eigen::Index count) : sums_(Eigen::ArrayXXd::Zero(count, 5)) {}

    /// `offset`: displacement minus that of the bin, over the width.
    void add(double offset, const Eigen::VectorXd& values) {
        const double weight = 1 - std::abs(offset);
        for (Eigen::Index q = 0; q < values.size(); ++q) {
            if (!std::isfinite(values[q])) continue;
            sums_(q, 0) += weight;
            sums_(q, 1) += weight * offset;
            sums_(q, 2) += weight * offset * offset;
            sums_(q, 3) += weight * values[q];
            sums_(q, 4) += weight * offset * values[q];
        }
    }

    double at_middle(Eigen::Index q) const {
        const double n = sums_(q, 0), x = sums_(q, 1), xx = sums_(q, 2), y = sums_(q, 3), xy = sums_(q, 4);
        const double determinant = n * xx - x * x;
        if (!(n > 0.3)) return unknown;
        if (!(determinant > 1e-3 * n * n)) return std::abs(x / n) < 0.1 ? y / n : unknown;
        return (xx * y - x * xy) / determinant;
    }

private:
    Eigen::ArrayXXd sums_;  // weight, x, x^2, y, x y by observable
};

}  // namespace

namespace {

/// Each hold with the scan at its start: the last one before it, if that is at the end of its leg.
std::vector<HoldScans> holds_of(const Recording& recording, const std::vector<ScanPlace>& places) {
    std::vector<HoldScans> holds;
    for (std::size_t k = 0; k < places.size() && k + 1 < recording.scans.size(); ++k) {
        if (!places[k].held) continue;
        const int scan = static_cast<int>(k) + 1;
        const bool begins = k == 0 || places[k - 1].leg != places[k].leg;
        if (begins) {
            const bool just_before = k == 0 || places[k - 1].at_end;
            holds.push_back({just_before ? scan - 1 : scan, scan, scan, places[k].by, Phase::load, 0});
        }
        holds.back().end = scan;
    }
    for (HoldScans& hold : holds) {
        const Scan& begin = recording.scans[hold.begin];
        hold.phase = recording.scans[hold.first].phase;
        hold.displacement = recording.displacement(begin);
    }
    return holds;
}

bool is_held(const Grid& grid, std::size_t scan) {
    const int number = static_cast<int>(scan);
    return std::ranges::any_of(
        grid.holds, [&](const HoldScans& hold) { return number >= hold.first && number <= hold.end; });
}

/// Sets the forces during loading at the displacements, interpolated between scans.
void set_forces(const Recording& recording, Grid& grid) {
    std::vector<std::pair<double, double>>
        curve;  // displacement, force; at the first time that it is reached
    for (std::size_t s = 0; s < recording.scans.size(); ++s) {
        const Scan& scan = recording.scans[s];
        const double displacement = recording.displacement(scan);
        if (scan.phase == Phase::load && !is_held(grid, s) &&
            (curve.empty() || displacement > curve.back().first))
            curve.emplace_back(displacement, scan.top_force());
    }
    double highest = 0;
    for (const double wanted : grid.displacement) {
        const auto above = std::ranges::find_if(curve, [&](auto& at) { return at.first >= wanted; });
        if (above == curve.end() || above == curve.begin()) continue;
        const auto below = above - 1;
        const double part = (wanted - below->first) / (above->first - below->first);
        grid.force.push_back(below->second + part * (above->second - below->second));
    }
    if (grid.force.size() < grid.displacement.size()) return grid.force.clear();
    for (const auto& [displacement, force] : curve) highest = std::max(highest, force);
    grid.force_width = grid.width / grid.stroke * highest;
}

}  // namespace

Grid grid_of(const Recording& experiment) {
    Grid grid;
    const auto programme = programme_of(experiment.parameters);
    grid.holds = holds_of(experiment, scan_places(programme, {experiment.plate_start, 0}));
    int loading = 0, cycles = 0;
    for (std::size_t s = 0; s < experiment.scans.size(); ++s) {
        const Scan& scan = experiment.scans[s];
        grid.stroke = std::max(grid.stroke, experiment.displacement(scan));
        loading += scan.phase == Phase::load && !is_held(grid, s) ? 1 : 0;
        cycles = std::max(cycles, scan.cycle + 1);
    }
    const double spacing = grid.stroke * cycles / std::max(1, loading);
    grid.width = std::max(width_of_stroke * grid.stroke, 1.6 * spacing);
    for (const double part : parts_of_stroke) grid.displacement.push_back(part * grid.stroke);
    if (std::ranges::any_of(programme, [](const Stage& stage) {
            return stage.kind != StageKind::hold && controlled(stage) == Controlled::force;
        }))
        set_forces(experiment, grid);
    return grid;
}

std::vector<Bin> bins_of(const Grid& grid) {
    std::vector<Bin> bins;
    for (std::size_t q = 0; q < observables().size(); ++q)
        for (const Phase phase : phases)
            for (const double displacement : grid.displacement)
                bins.push_back({static_cast<int>(q), phase, displacement});
    return bins;
}

namespace {

/// Observables of a scan in a stroke. Of displacement and force, only the one that is not prescribed.
Eigen::VectorXd stroke_observables(const Recording& recording, const Scan& scan, const Grid& grid,
                                   const ReferenceMaterial& material) {
    Eigen::VectorXd values = scan_observables(recording, scan, material);
    if (!grid.force.empty()) {
        values[0] = unknown;  // the force on the plate
        values[index_of(OfProgramme::displacement)] = recording.displacement(scan) / grid.stroke;
    }
    return values;
}

/// Distance of a scan from a grid point, over the width.
double offset_of(const Recording& recording, const Scan& scan, const Grid& grid, std::size_t place) {
    if (grid.force.empty()) return (recording.displacement(scan) - grid.displacement[place]) / grid.width;
    return (scan.top_force() - grid.force[place]) / grid.force_width;
}

std::size_t nearest_place(const Grid& grid, double displacement) {
    const auto nearest = std::ranges::min_element(
        grid.displacement, {}, [&](double place) { return std::abs(place - displacement); });
    return static_cast<std::size_t>(nearest - grid.displacement.begin());
}

/// Adds the observables of holds, each at the nearest displacement; the mean if there are several.
void add_holds(const Recording& recording, const Grid& grid, int discard, std::vector<LocalLine>& lines) {
    for (const HoldScans& hold : grid.holds) {
        if (static_cast<std::size_t>(hold.end) >= recording.scans.size() || hold.begin == hold.end) continue;
        const Scan& begin = recording.scans[hold.begin];
        const Scan& end = recording.scans[hold.end];
        if (end.cycle < discard) continue;
        Eigen::VectorXd values =
            Eigen::VectorXd::Constant(static_cast<Eigen::Index>(observables().size()), unknown);
        if (hold.keep == Controlled::force)
            values[index_of(OfProgramme::creep)] = (begin.plate_z - end.plate_z) / grid.stroke;
        else if (begin.top_force() > 0 && end.top_force() > 0)
            values[index_of(OfProgramme::relaxation)] = std::log(begin.top_force() / end.top_force());
        const std::size_t place = nearest_place(grid, hold.displacement);
        lines[(hold.phase == Phase::load ? 0 : grid.displacement.size()) + place].add(0, values);
    }
}

}  // namespace

Eigen::VectorXd observe(const Recording& recording, const Grid& grid, const ReferenceMaterial& material,
                        int discard) {
    const auto count = static_cast<Eigen::Index>(observables().size());
    const std::size_t places = grid.displacement.size();
    std::vector<LocalLine> lines(std::size(phases) * places, LocalLine(count));
    for (std::size_t s = 0; s < recording.scans.size(); ++s) {
        const Scan& scan = recording.scans[s];
        if (scan.cycle < discard || is_held(grid, s)) continue;
        Eigen::VectorXd values;
        for (std::size_t place = 0; place < places; ++place) {
            const double offset = offset_of(recording, scan, grid, place);
            if (!(std::abs(offset) < 1)) continue;
            if (values.size() == 0) values = stroke_observables(recording, scan, grid, material);
            lines[(scan.phase == Phase::load ? 0 : places) + place].add(offset, values);
        }
    }
    add_holds(recording, grid, discard, lines);
    Eigen::VectorXd result(count * static_cast<Eigen::Index>(lines.size()));
    for (Eigen::Index q = 0, next = 0; q < count; ++q)
        for (const LocalLine& line : lines) result[next++] = line.at_middle(q);
    return result;
}

}  // namespace mcdem::diagnose
