#include "scene/overlap_relaxation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scene/cell_pairs.h"

namespace mcdem::inline scene {
namespace {

double largest(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }

/// FIRE (Bitzek et al. 2006) with its published constants. Stiffness and mass are 1, so times are in units
/// of their ratio; 0.4 is below the stability limit of a grain with a dozen contacts.
struct Fire {
    static constexpr double max_time_step = 0.4, start_step = 0.1, start_mixing = 0.1;
    static constexpr double faster = 1.1, slower = 0.5, less_mixing = 0.99;
    static constexpr int patience = 5;

    double time_step = start_step, mixing = start_mixing;
    int downhill = 0;

    /// True where the motion goes uphill and has to stop.
    bool uphill(double power) {
        if (power <= 0) {
            downhill = 0;
            time_step *= slower;
            mixing = start_mixing;
            return true;
        }
        if (++downhill > patience) {
            time_step = std::min(time_step * faster, max_time_step);
            mixing *= less_mixing;
        }
        return false;
    }
};

}  // namespace

double largest_overlap(const Packing& packing, const Box& box, double height) {
    const std::array<double, 3> size{box.size_x, box.size_y, height};
    double most = 0;
    for (std::size_t i = 0; i < packing.size(); ++i) {
        const double radius = packing.diameter[i] / 2;
        for (int axis = 0; axis < 3; ++axis) {
            const double x = packing.position[i][axis];
            most = std::max(most, (radius - std::min(x, size[axis] - x)) / radius);
        }
    }
    const CellList cells(packing.position, size, largest(packing.diameter));
    cells.for_each_pair([&](int i, int j) {
        const double reach = (packing.diameter[i] + packing.diameter[j]) / 2;
        const double distance = (packing.position[j] - packing.position[i]).norm();
        most = std::max(most, 2 * (reach - distance) / std::min(packing.diameter[i], packing.diameter[j]));
    });
    return most;
}

OverlapRelaxation::OverlapRelaxation(const Packing& packing, const Box& box, double height)
    : size_{box.size_x, box.size_y, height},
      position_(packing.position),
      velocity_(packing.size(), Vec3::Zero()),
      force_(packing.size(), Vec3::Zero()) {
    for (double d : packing.diameter) radius_.push_back(d / 2);
    mean_radius_ = std::accumulate(radius_.begin(), radius_.end(), 0.0) / static_cast<double>(radius_.size());
    margin_ = 0.15 * mean_radius_;
}

int OverlapRelaxation::relax(double scale, int iterations) {
    constexpr double negligible = 5e-3;  // overlap over the mean radius
    constexpr double balanced = 1e-2;    // net forces over contact forces, root mean squares
    std::fill(velocity_.begin(), velocity_.end(), Vec3::Zero());
    Fire fire;
    for (int iteration = 0; iteration < iterations; ++iteration) {
        find_pairs_when_needed();
        const Sums sums = push_apart(scale);
        if (sums.largest < negligible * mean_radius_) return iteration;
        if (sums.force_square < balanced * balanced * sums.overlap_square) return iteration;
        if (fire.uphill(sums.power) && iteration > 0) {
            std::fill(velocity_.begin(), velocity_.end(), Vec3::Zero());
        } else {
            const double turn = fire.mixing * std::sqrt(sums.speed_square / sums.force_square);
            for (std::size_t i = 0; i < position_.size(); ++i)
                velocity_[i] = (1 - fire.mixing) * velocity_[i] + turn * force_[i];
        }
        move(fire.time_step);
    }
    return iterations;
}

OverlapRelaxation::Sums OverlapRelaxation::push_apart(double scale) {
    Sums sums;
    for (std::size_t i = 0; i < position_.size(); ++i) {
        force_[i].setZero();
        push_from_walls(static_cast<int>(i), scale * radius_[i], sums);
    }
    for (const auto [i, j] : pairs_) {
        const Vec3 apart = position_[j] - position_[i];
        const double reach = scale * (radius_[i] + radius_[j]);
        const double square = apart.squaredNorm();
        if (square >= reach * reach || square == 0) continue;
        const double distance = std::sqrt(square);
        const double overlap = reach - distance;
        const Vec3 push = (overlap / distance) * apart;
        force_[j] += push;
        force_[i] -= push;
        sums.largest = std::max(sums.largest, overlap);
        sums.overlap_square += overlap * overlap;
    }
    for (std::size_t i = 0; i < position_.size(); ++i) {
        sums.power += force_[i].dot(velocity_[i]);
        sums.force_square += force_[i].squaredNorm();
        sums.speed_square += velocity_[i].squaredNorm();
    }
    return sums;
}

void OverlapRelaxation::push_from_walls(int grain, double radius, Sums& sums) {
    for (int axis = 0; axis < 3; ++axis) {
        const double x = position_[grain][axis];
        for (const double overlap : {radius - x, x - (size_[axis] - radius)}) {
            if (overlap <= 0) continue;
            force_[grain][axis] += overlap == radius - x ? overlap : -overlap;
            sums.largest = std::max(sums.largest, overlap);
            sums.overlap_square += overlap * overlap;
        }
    }
}

void OverlapRelaxation::move(double time_step) {
    // No grain travels further than a fifth of the mean radius: random starts overlap strongly.
    const double farthest = 0.2 * mean_radius_;
    for (std::size_t i = 0; i < position_.size(); ++i) {
        velocity_[i] += time_step * force_[i];
        const double travel = velocity_[i].norm() * time_step;
        if (travel > farthest) velocity_[i] *= farthest / travel;
        position_[i] += time_step * velocity_[i];
        for (int axis = 0; axis < 3; ++axis)
            position_[i][axis] = std::clamp(position_[i][axis], 0.0, size_[axis]);
    }
}

void OverlapRelaxation::find_pairs_when_needed() {
    bool stale = listed_position_.empty();
    const double allowed = margin_ * margin_ / 4;
    for (std::size_t i = 0; !stale && i < position_.size(); ++i)
        stale = (position_[i] - listed_position_[i]).squaredNorm() > allowed;
    if (stale) find_pairs();
}

void OverlapRelaxation::find_pairs() {
    listed_position_ = position_;
    pairs_.clear();
    const CellList cells(position_, size_, 2 * largest(radius_) + margin_);
    cells.for_each_pair([&](int i, int j) {
        const double reach = radius_[i] + radius_[j] + margin_;
        if ((position_[j] - position_[i]).squaredNorm() < reach * reach) pairs_.push_back({i, j});
    });
}

}  // namespace mcdem::scene
