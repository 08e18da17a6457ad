#include "scene/packing/overlap_relaxation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/container.h"
#include "core/near_pairs.h"

namespace mcdem::inline scene {
namespace {

/// FIRE (Bitzek et al. 2006) with its published constants. Stiffness and mass are 1, which defines the unit
/// of time; 0.4 is below the stability limit of a grain with a dozen contacts.
struct Fire {
    static constexpr double max_time_step = 0.4, start_step = 0.1, start_mixing = 0.1;
    static constexpr double faster = 1.1, slower = 0.5, less_mixing = 0.99;
    static constexpr int patience = 5;

    double time_step = start_step, mixing = start_mixing;
    int downhill = 0;

    /// True if the motion increases the energy and must stop.
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

OverlapRelaxation::OverlapRelaxation(const Packing& packing, const Box& box, double height)
    : box_(box),
      height_(height),
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
        const Vec3 apart = core::apart(box_, position_[i], position_[j]);
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
    const auto push = [&](double overlap, const Vec3& inward) {
        if (overlap <= 0) return;
        force_[grain] += overlap * inward;
        sums.largest = std::max(sums.largest, overlap);
        sums.overlap_square += overlap * overlap;
    };
    const Vec3& at = position_[grain];
    if (is_cylinder(box_)) {
        const Vec3 out = from_axis(box_, at);
        push(out.norm() - (cylinder_radius(box_) - radius), -out.normalized());
    }
    if (is_cell(box_)) return;
    const double size[]{box_.size_x, box_.size_y, height_};
    for (int axis = box_.shape == ContainerShape::box ? 0 : 2; axis < 3; ++axis) {
        push(radius - at[axis], Vec3::Unit(axis));
        push(at[axis] - (size[axis] - radius), -Vec3::Unit(axis));
    }
}

void OverlapRelaxation::move(double time_step) {
    // No grain moves further than a fifth of the mean radius per step, because random initial positions
    // overlap strongly.
    const double farthest = 0.2 * mean_radius_;
    for (std::size_t i = 0; i < position_.size(); ++i) {
        velocity_[i] += time_step * force_[i];
        const double travel = velocity_[i].norm() * time_step;
        if (travel > farthest) velocity_[i] *= farthest / travel;
        position_[i] += time_step * velocity_[i];
        keep_inside(position_[i]);
    }
}

void OverlapRelaxation::keep_inside(Vec3& point) const {
    if (is_cell(box_)) return;
    point.z() = std::clamp(point.z(), 0.0, height_);
    if (is_periodic(box_)) return;
    point.x() = std::clamp(point.x(), 0.0, box_.size_x);
    point.y() = std::clamp(point.y(), 0.0, box_.size_y);
    if (!is_cylinder(box_)) return;
    const Vec3 out = from_axis(box_, point);
    if (out.norm() > cylinder_radius(box_)) point += (cylinder_radius(box_) / out.norm() - 1) * out;
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
    std::vector<Vec3> inside;
    for (const Vec3& point : position_) inside.push_back(into_cell(box_, point));
    const NeighbourGrid grid(inside, box_, height_, 2 * std::ranges::max(radius_) + margin_);
    grid.for_each_pair([&](int i, int j) {
        const double reach = radius_[i] + radius_[j] + margin_;
        if (core::apart(box_, position_[i], position_[j]).squaredNorm() < reach * reach)
            pairs_.push_back({i, j});
    });
}

}  // namespace mcdem::scene
