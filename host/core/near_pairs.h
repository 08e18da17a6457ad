// Pairs of neighbouring spheres in a container, found with a grid.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/container.h"

namespace mcdem::inline core {

/// Grains sorted by the cubic grid cell that contains their centre.
class NeighbourGrid {
public:
    /// `edge`: maximum distance of a pair; grid cells are larger if they would far outnumber the grains. The
    /// list extends up to `height`. In a periodic cell, positions must be inside it.
    NeighbourGrid(const std::vector<Vec3>& position, const Box& box, double height, double edge)
        : repeats_{is_periodic(box), is_periodic(box), is_cell(box)} {
        const double size[]{box.size_x, box.size_y, height};
        const double volume = size[0] * size[1] * size[2];
        const double enough = 8.0 * static_cast<double>(position.size()) + 64.0;
        edge = std::max(edge, std::cbrt(volume / enough));
        for (int axis = 0; axis < 3; ++axis)
            cells_[axis] = static_cast<int>(std::clamp(size[axis] / edge, 1.0, 1e9));
        // In a box flatter or thinner than `edge`, the volume alone does not limit the number of cells.
        while (static_cast<double>(cells_[0]) * cells_[1] * cells_[2] > 16 * enough)
            *std::ranges::max_element(cells_) /= 2;
        // With fewer than three cells along a periodic axis, pairs of cells would be visited twice.
        for (int axis = 0; axis < 3; ++axis)
            if (repeats_[axis] && cells_[axis] < 3) cells_[axis] = 1;
        for (int axis = 0; axis < 3; ++axis) edge_[axis] = size[axis] / cells_[axis];
        sort(position);
    }

    /// Calls `visit(i, j)` once for every pair of grains in the same or adjacent cells.
    template <class Visit>
    void for_each_pair(const Visit& visit) const {
        for (int z = 0; z < cells_[2]; ++z)
            for (int y = 0; y < cells_[1]; ++y)
                for (int x = 0; x < cells_[0]; ++x) visit_cell({x, y, z}, visit);
    }

private:
    using GridCell = std::array<int, 3>;

    std::size_t index(const GridCell& cell) const {
        return (static_cast<std::size_t>(cell[2]) * cells_[1] + cell[1]) * cells_[0] + cell[0];
    }

    GridCell cell_of(const Vec3& position) const {
        GridCell cell;
        for (int axis = 0; axis < 3; ++axis)
            cell[axis] = static_cast<int>(std::clamp(position[axis] / edge_[axis], 0.0, cells_[axis] - 1.0));
        return cell;
    }

    void sort(const std::vector<Vec3>& position) {
        first_.assign(static_cast<std::size_t>(cells_[0]) * cells_[1] * cells_[2] + 1, 0);
        for (const Vec3& p : position) ++first_[index(cell_of(p)) + 1];
        for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
        std::vector<int> next(first_.begin(), first_.end() - 1);
        sorted_.resize(position.size());
        for (std::size_t i = 0; i < position.size(); ++i)
            sorted_[next[index(cell_of(position[i]))]++] = static_cast<int>(i);
    }

    /// False beyond a non-periodic end, or for the same layer again.
    bool wrap(GridCell& cell) const {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const bool past = cell[axis] < 0 || cell[axis] >= cells_[axis];
            if (past && (!repeats_[axis] || cells_[axis] == 1)) return false;
            cell[axis] = (cell[axis] + cells_[axis]) % cells_[axis];
        }
        return true;
    }

    template <class Visit>
    void visit_cell(const GridCell& cell, const Visit& visit) const {
        // Half of the 26 neighbours, so that each pair of cells is visited once.
        static constexpr int half[13][3] = {{1, 0, 0},  {-1, 1, 0}, {0, 1, 0},  {1, 1, 0}, {-1, -1, 1},
                                            {0, -1, 1}, {1, -1, 1}, {-1, 0, 1}, {0, 0, 1}, {1, 0, 1},
                                            {-1, 1, 1}, {0, 1, 1},  {1, 1, 1}};
        const std::size_t here = index(cell);
        for (int a = first_[here]; a < first_[here + 1]; ++a)
            for (int b = a + 1; b < first_[here + 1]; ++b) visit(sorted_[a], sorted_[b]);
        for (const auto& step : half) {
            GridCell other{cell[0] + step[0], cell[1] + step[1], cell[2] + step[2]};
            if (!wrap(other)) continue;
            const std::size_t there = index(other);
            for (int a = first_[here]; a < first_[here + 1]; ++a)
                for (int b = first_[there]; b < first_[there + 1]; ++b) visit(sorted_[a], sorted_[b]);
        }
    }

    std::array<bool, 3> repeats_{};
    std::array<int, 3> cells_{};
    std::array<double, 3> edge_{};
    std::vector<int> first_, sorted_;
};

}  // namespace mcdem::core
