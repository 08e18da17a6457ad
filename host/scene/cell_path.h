// The way of a cell through its programme: straight from the strains that one move ends at to those of the
// next.
#pragma once
#include <vector>

#include "scene/legs.h"

namespace mcdem::inline scene {

/// Places on it are told by its length: of a move, the largest of the changes of the six strains.
class CellPath {
public:
    CellPath(const std::vector<Stage>& stages, const std::vector<Leg>& legs);

    /// Where a leg ends.
    double end(int leg) const { return length_[static_cast<std::size_t>(leg) + 1]; }
    /// At a place on a leg.
    Strain strain(int leg, double place) const;
    /// How strains change along a leg.
    Strain direction(int leg) const;
    /// The volume shrinks, or, where it stays, the shears grow.
    bool loads(int leg) const;

private:
    std::vector<Strain> strain_;  ///< before each leg and after the last
    std::vector<double> length_;
};

/// The cell with the shortest lengths that the replica's programme gives it, upright.
Box smallest_cell(const Replica& replica);

/// What a move's strains are, those that it does not name as they were.
Strain strain_after(const Stage& stage, Strain before);

}  // namespace mcdem::scene
