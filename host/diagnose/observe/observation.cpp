#include "diagnose/observe/observation.h"

#include <algorithm>
#include <cmath>

#include "metrics/estimate.h"

namespace mcdem::inline diagnose {
namespace {

constexpr double parts_of_stroke[] = {0.42, 0.61, 0.80, 0.98};
constexpr double width_of_stroke = 0.12;
constexpr Phase phases[] = {Phase::load, Phase::unload};

/// Weighted straight lines through the observables of some scans, evaluated in the middle.
class LocalLine {
public:
    explicit LocalLine(Eigen::Index count) : sums_(Eigen::ArrayXXd::Zero(count, 5)) {}

    /// `offset`: displacement less that of the cell, over the width.
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
        if (!(n > 0.3)) return not_available;
        if (!(determinant > 1e-3 * n * n)) return std::abs(x / n) < 0.1 ? y / n : not_available;
        return (xx * y - x * xy) / determinant;
    }

private:
    Eigen::ArrayXXd sums_;  // weight, x, x^2, y, x y by observable
};

}  // namespace

Grid grid_of(const Recording& experiment) {
    Grid grid;
    int loading = 0, cycles = 0;
    for (const Scan& scan : experiment.scans) {
        grid.stroke = std::max(grid.stroke, experiment.displacement(scan));
        loading += scan.phase == Phase::load ? 1 : 0;
        cycles = std::max(cycles, scan.cycle + 1);
    }
    const double spacing = grid.stroke * cycles / std::max(1, loading);
    grid.width = std::max(width_of_stroke * grid.stroke, 1.6 * spacing);
    for (const double part : parts_of_stroke) grid.displacement.push_back(part * grid.stroke);
    return grid;
}

std::vector<Cell> cells_of(const Grid& grid) {
    std::vector<Cell> cells;
    for (std::size_t q = 0; q < observables().size(); ++q)
        for (const Phase phase : phases)
            for (const double displacement : grid.displacement)
                cells.push_back({static_cast<int>(q), phase, displacement});
    return cells;
}

Eigen::VectorXd observe(const Recording& recording, const Grid& grid, const ReferenceMaterial& material,
                        int discard) {
    const auto count = static_cast<Eigen::Index>(observables().size());
    const std::size_t places = grid.displacement.size();
    std::vector<LocalLine> lines(std::size(phases) * places, LocalLine(count));
    for (const Scan& scan : recording.scans) {
        if (scan.cycle < discard) continue;
        Eigen::VectorXd values;
        for (std::size_t place = 0; place < places; ++place) {
            const double offset = (recording.displacement(scan) - grid.displacement[place]) / grid.width;
            if (std::abs(offset) >= 1) continue;
            if (values.size() == 0) values = scan_observables(recording, scan, material);
            lines[(scan.phase == Phase::load ? 0 : places) + place].add(offset, values);
        }
    }
    Eigen::VectorXd result(count * static_cast<Eigen::Index>(lines.size()));
    for (Eigen::Index q = 0, next = 0; q < count; ++q)
        for (const LocalLine& line : lines) result[next++] = line.at_middle(q);
    return result;
}

}  // namespace mcdem::diagnose
