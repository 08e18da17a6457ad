// Strain path of a cell in its programme: each move is a straight line between the strains before and after
// it. Directions with a prescribed stress have their own strains.
#pragma once
#include "scene/programme/legs.h"

namespace mcdem::inline scene {

/// One move that starts at `from`. Positions along it are measured by the largest change of the six strains
/// and start at `begin`.
struct CellMove {
    CellMove(const Stage& stage, const Strain& before, double begin);

    /// Strain at a position along the move.
    Strain strain(double place) const;
    /// Change of the strain per position.
    Strain direction() const;
    /// True if the volume decreases, or is constant while shear increases.
    bool loads() const;

    Strain from, to;
    double begin, end;
};

/// The cell with the smallest lengths in the replica's programme, upright.
Box smallest_cell(const Replica& replica);

/// Strains after a move; those that it does not name do not change.
Strain strain_after(const Stage& stage, Strain before);

}  // namespace mcdem::scene
