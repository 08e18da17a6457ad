// Relaxation of overlapping spheres in a container. The energy of each pair and each wall contact is half the
// square of its overlap; the sum is minimised with FIRE. No weight, no friction.
#pragma once
#include <vector>

#include "core/packing.h"

namespace mcdem::inline scene {

class OverlapRelaxation {
public:
    /// The packing has the final diameters and the initial positions.
    OverlapRelaxation(const Packing& packing, const Box& box, double height);

    /// Minimises with all radii multiplied by `scale`, until the overlaps are gone (below a thousandth of the
    /// mean radius), forces balance, or `iterations` are used up. Returns the number of iterations.
    int relax(double scale, int iterations);

    const std::vector<Vec3>& position() const { return position_; }

private:
    struct Pair {
        int i, j;
    };
    struct Sums {
        double power = 0;         ///< force . velocity
        double force_square = 0;  ///< of net forces
        double speed_square = 0;
        double largest = 0;         ///< largest overlap
        double overlap_square = 0;  ///< sum over all pairs and walls
    };

    Sums push_apart(double scale);
    void push_from_walls(int grain, double radius, Sums& sums);
    void move(double time_step);
    void keep_inside(Vec3& point) const;
    void find_pairs_when_needed();
    void find_pairs();

    std::vector<double> radius_;
    Box box_;
    double height_;  ///< of the box [m]
    double mean_radius_ = 0;
    double margin_ = 0;  ///< largest gap of listed pairs [m]
    std::vector<Vec3> position_, velocity_, force_, listed_position_;
    std::vector<Pair> pairs_;
};

}  // namespace mcdem::scene
