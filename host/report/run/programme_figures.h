// Figures of programmes, scan by scan: force and displacement of a plate, stress and strain of a cell,
// against one another and against time.
#pragma once
#include "report/run/run_figures.h"

namespace mcdem::inline report {

/// Figures that have data. Time is shown for plates, and for cells with a hold; figures of distortion only
/// for cells that are distorted.
std::vector<RunFigure> programme_figures(const Cast& cast);

}  // namespace mcdem::report
