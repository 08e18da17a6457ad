// mcdem.forces_along
#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <optional>

#include "core/errors.h"
#include "ensemble/make_packings.h"
#include "python/bindings.h"
#include "python/watch.h"
#include "sim/forces_along.h"

namespace mcdem::inline python {
namespace {

namespace py = pybind11;
using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::string shape_text(const Array& array) { return py::str(array.attr("shape")).cast<std::string>(); }

/// One value a row and grain: a vector.
void expect_vectors(const char* name, const Array& array, py::ssize_t rows, std::size_t grains) {
    if (array.ndim() == 3 && array.shape(0) == rows && array.shape(1) == static_cast<py::ssize_t>(grains) &&
        array.shape(2) == 3)
        return;
    throw InputError(fmt::format(
        "{}: must have the shape ({}, {}, 3), as many times as `time` and grains as the scene, got {}", name,
        rows, grains, shape_text(array)));
}

Vec3 vector_at(const Array& array, std::size_t row, std::size_t grain) {
    const auto r = static_cast<py::ssize_t>(row), g = static_cast<py::ssize_t>(grain);
    return {array.at(r, g, 0), array.at(r, g, 1), array.at(r, g, 2)};
}

/// Velocities that are not given are those of the way from the row before; those of the first row, of the way
/// to the next one.
void fill_velocities(const std::vector<double>& time, std::vector<GrainMotion>& path) {
    for (std::size_t row = 1; row < path.size(); ++row)
        for (const Vec3& position : path[row].position) {
            const std::size_t grain = path[row].velocity.size();
            path[row].velocity.push_back((position - path[row - 1].position[grain]) /
                                         (time[row] - time[row - 1]));
        }
    const std::vector<Vec3> still(path.front().position.size(), Vec3::Zero());
    path.front().velocity = path.size() > 1 ? path[1].velocity : still;
}

Array array_of(const std::vector<GrainForces>& rows, std::vector<Vec3> GrainForces::*quantity,
               std::size_t grains) {
    Array array({static_cast<py::ssize_t>(rows.size()), static_cast<py::ssize_t>(grains), py::ssize_t{3}});
    double* out = array.mutable_data();
    for (const GrainForces& row : rows)
        for (const Vec3& vector : row.*quantity)
            for (int axis = 0; axis < 3; ++axis) *out++ = vector[axis];
    return array;
}

py::tuple forces_of_path(const Scene& scene, const Array& time, const Array& position,
                         const std::optional<Array>& velocity, const std::optional<Array>& spin,
                         const std::string& choice) {
    if (time.ndim() != 1 || time.shape(0) == 0)
        throw InputError(fmt::format("time: must have the shape (T,) with T >= 1, got {}", shape_text(time)));
    const std::vector<Packing> packings = make_packings(scene);
    const std::size_t grains = packings.front().size();
    expect_vectors("position", position, time.shape(0), grains);
    if (velocity) expect_vectors("velocity", *velocity, time.shape(0), grains);
    if (spin) expect_vectors("spin", *spin, time.shape(0), grains);
    const std::vector<double> times(time.data(), time.data() + time.size());
    std::vector<GrainMotion> path(times.size());
    for (std::size_t row = 0; row < path.size(); ++row)
        for (std::size_t i = 0; i < grains; ++i) {
            path[row].position.push_back(vector_at(position, row, i));
            if (velocity) path[row].velocity.push_back(vector_at(*velocity, row, i));
            path[row].angular_velocity.push_back(spin ? vector_at(*spin, row, i) : Vec3::Zero());
        }
    if (!velocity) fill_velocities(times, path);
    Watch watch{py::none()};
    const std::vector<GrainForces> forces = without_gil(watch, [&] {
        Device device(choice);
        return forces_along(device, scene, packings.front(), times, path,
                            [&] { return watch.stop_wanted(); });
    });
    return py::make_tuple(array_of(forces, &GrainForces::force, grains),
                          array_of(forces, &GrainForces::torque, grains));
}

}  // namespace

void bind_path(py::module_& module) {
    module.def(
        "forces_along", &forces_of_path, py::arg("scene"), py::arg("time"), py::arg("position"),
        py::arg("velocity") = py::none(), py::arg("spin") = py::none(), py::kw_only(), py::arg("device") = "",
        "The contact forces on grains that move along a prescribed path, one time step a row: (force [N], "
        "torque\n"
        "about the grain's centre [N m]), two arrays of the shape (T, N, 3).\n\n"
        "`scene`: one replica with N grains; only their diameters and species are used, not their positions. "
        "Its\n"
        "plate stands still at plate.start. `time`: (T,), increasing [s]. `position`: (T, N, 3) [m]. "
        "`velocity`\n"
        "[m/s] and `spin` [1/s]: (T, N, 3), those of the step that ends at the row, as in leapfrog "
        "integration;\n"
        "default: the change of position over that of time (first row: that of the second), and no spin.\n\n"
        "Contacts keep their memory along the path; in the first row they have none. Weight and drag are not "
        "among\n"
        "the forces. Set numerics.precision = 'double' for smooth differences. ValueError: another shape, "
        "values\n"
        "that are not finite, a centre outside the container, an overlap above numerics.overlap_limit, a "
        "step that\n"
        "moves a grain by more than half of numerics.skin times the mean radius, rolling resistance.");
}

}  // namespace mcdem::python
