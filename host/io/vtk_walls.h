// A container's walls as surfaces, and the edges of a periodic one.
#pragma once
#include <vector>

#include "core/recording.h"
#include "io/vtk_grid.h"

namespace mcdem::inline io {

/// Cells with the wall that each belongs to; -1: an edge of a cell that repeats. Side walls reach from the
/// floor to where the plate started; a cell is the upright one that grains are in.
struct VtkWalls {
    VtkCells cells;
    std::vector<int> wall;
};
VtkWalls vtk_walls(const Recording& recording, const Scan& scan);

}  // namespace mcdem::io
