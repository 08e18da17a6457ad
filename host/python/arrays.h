// NumPy arrays that refer to the memory of a recording: nothing is copied, and they keep the recording alive.
#pragma once
#include <pybind11/numpy.h>

#include "core/recording.h"

namespace mcdem::inline python {

/// Each array is read-only with `owner` as its base. Shapes: [S] rows with the names in run.h5, [S][6][3],
/// [S], [S][3][3], [N], [N][3], [C] rows.
pybind11::array scans_array(const Recording& recording, pybind11::handle owner);
pybind11::array wall_force_array(const Recording& recording, pybind11::handle owner);
pybind11::array top_force_array(const Recording& recording, pybind11::handle owner);
pybind11::array strain_array(const Recording& recording, pybind11::handle owner);
pybind11::array tensor_array(const Recording& recording, Mat3 Scan::*tensor, pybind11::handle owner);
pybind11::array diameter_array(const Recording& recording, pybind11::handle owner);
pybind11::array species_array(const Recording& recording, pybind11::handle owner);
pybind11::array position_array(const Scan& scan, pybind11::handle owner);
pybind11::array rotation_array(const Scan& scan, pybind11::handle owner);
pybind11::array contact_array(const Scan& scan, pybind11::handle owner);

/// [N][3][3], a copy.
pybind11::array grain_stress_array(const Recording& recording, const Scan& scan);

}  // namespace mcdem::python
