// mcdem._engine.ConvergenceSimulator (ensemble/diagnosis/convergence_simulator.h)
#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "core/version.h"
#include "ensemble/diagnosis/convergence_simulator.h"
#include "python/bindings.h"
#include "python/grid_dict.h"
#include "python/watch.h"

namespace mcdem::inline python {

namespace py = pybind11;

void bind_convergence_simulator(py::module_& module) {
    py::class_<ConvergenceSimulator>(module, "ConvergenceSimulator",
                                     "Simulations of a scene with changed numerics.")
        .def(py::init([](const Scene& scene, const std::filesystem::path& folder, int replicas, double jitter,
                         std::uint64_t seed, const std::string& device) {
                 return watched(py::none(), [&](const auto&) {
                     return std::make_unique<ConvergenceSimulator>(scene, folder, replicas, jitter, seed,
                                                                   version_text, device);
                 });
             }),
             py::arg("scene"), py::arg("folder"), py::kw_only(), py::arg("replicas"), py::arg("jitter"),
             py::arg("seed"), py::arg("device"))
        .def_property_readonly("device_name",
                               [](const ConvergenceSimulator& s) { return s.device().info().name; })
        .def_property_readonly("draws_packings", &ConvergenceSimulator::draws_packings)
        .def(
            "find_grid",
            [](ConvergenceSimulator& s, py::object progress) {
                watched(std::move(progress), [&](const auto& options) { return s.find_grid(options), 0; });
                return dict_of(s.grid());
            },
            py::arg("progress") = py::none())
        .def(
            "observe",
            [](ConvergenceSimulator& s, const py::dict& changes, py::object progress) {
                const KeyValues values = key_values(changes);
                return watched(std::move(progress),
                               [&](const auto& options) { return s.observe(values, options); });
            },
            py::arg("changes"), py::arg("progress") = py::none())
        .def("draw_packings", [](ConvergenceSimulator& s) {
            watched(py::none(), [&](const auto& options) { return s.draw_packings(options.stop_wanted), 0; });
        });
}

}  // namespace mcdem::python
