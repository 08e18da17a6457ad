// Walls of a container as surfaces, and the edges of a periodic container.
#pragma once
#include <vector>

#include "core/recording.h"
#include "io/vtk_grid.h"

namespace mcdem::inline io {

/// Cells with the wall of each; -1: an edge of a periodic container. Side walls extend from the floor to the
/// initial height of the plate; a `cell` is drawn as the upright cell that contains the positions.
struct VtkWalls {
    VtkCells cells;
    std::vector<int> wall;
};
VtkWalls vtk_walls(const Recording& recording, const Scan& scan);

}  // namespace mcdem::io
