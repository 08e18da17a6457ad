// The way of a cell through its programme: each move goes straight from the strains before it to those that
// it names, while the directions whose stress it sets find their own strains.
#pragma once
#include "scene/legs.h"

namespace mcdem::inline scene {

/// One move, from `from` on. Places on it are told by its length, the largest of the changes of the six
/// strains, and count from `begin`.
struct CellMove {
    CellMove(const Stage& stage, const Strain& before, double begin);

    /// At a place on it.
    Strain strain(double place) const;
    /// How strains change along it.
    Strain direction() const;
    /// The volume shrinks, or, where it stays, the shears grow.
    bool loads() const;

    Strain from, to;
    double begin, end;
};

/// The cell with the shortest lengths that the strains of the replica's programme give it, upright.
Box smallest_cell(const Replica& replica);

/// What a move's strains are, those that it does not name as they were.
Strain strain_after(const Stage& stage, Strain before);

}  // namespace mcdem::scene
