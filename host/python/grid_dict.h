// A Grid as a dict, and back (diagnosis/observables.py: Grid).
#pragma once
#include <pybind11/pybind11.h>

#include "diagnose/observe/observation.h"

namespace mcdem::inline python {

pybind11::dict dict_of(const Grid& grid);
Grid grid_from(const pybind11::dict& values);

}  // namespace mcdem::python
