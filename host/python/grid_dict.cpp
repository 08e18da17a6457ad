#include "python/grid_dict.h"

#include <pybind11/stl.h>

namespace mcdem::inline python {

namespace py = pybind11;

py::dict dict_of(const Grid& grid) {
    py::list holds;
    for (const HoldScans& hold : grid.holds)
        holds.append(py::dict(py::arg("begin") = hold.begin, py::arg("first") = hold.first,
                              py::arg("end") = hold.end, py::arg("keep") = name(hold.keep),
                              py::arg("phase") = static_cast<int>(hold.phase),
                              py::arg("displacement") = hold.displacement));
    return py::dict(py::arg("displacement") = grid.displacement, py::arg("width") = grid.width,
                    py::arg("stroke") = grid.stroke, py::arg("force") = grid.force,
                    py::arg("force_width") = grid.force_width, py::arg("holds") = holds);
}

Grid grid_from(const py::dict& values) {
    Grid grid;
    grid.displacement = values["displacement"].cast<std::vector<double>>();
    grid.width = values["width"].cast<double>();
    grid.stroke = values["stroke"].cast<double>();
    grid.force = values["force"].cast<std::vector<double>>();
    grid.force_width = values["force_width"].cast<double>();
    for (const py::handle& row : values["holds"]) {
        const auto hold = row.cast<py::dict>();
        grid.holds.push_back({hold["begin"].cast<int>(), hold["first"].cast<int>(), hold["end"].cast<int>(),
                              *parse<Controlled>(hold["keep"].cast<std::string>()),
                              static_cast<Phase>(hold["phase"].cast<int>()),
                              hold["displacement"].cast<double>()});
    }
    return grid;
}

}  // namespace mcdem::python
