// mcdem._engine.CaseSimulator: the simulated experiments of a challenge
// (ensemble/diagnosis/case_simulator.h).
#include <pybind11/stl.h>

#include "core/errors.h"
#include "core/random.h"
#include "ensemble/diagnosis/case_simulator.h"
#include "ensemble/diagnosis/outside_effects.h"
#include "python/bindings.h"
#include "python/watch.h"

namespace mcdem::inline python {
namespace {

namespace py = pybind11;

/// Folder, effects, nuisances, packing, seed.
using CaseTuple = std::tuple<std::string, Amplitudes, Amplitudes, int, std::uint64_t>;

py::list effects_of(const CaseSimulator& simulator) {
    py::list all;
    for (const Effect& effect : effects())
        all.append(py::make_tuple(effect.name, effect.scale(simulator.stated()),
                                  effect.hindrance(simulator.stated())));
    return all;
}

py::list nuisances_of(const CaseSimulator& simulator) {
    py::list all;
    for (const Nuisance& nuisance : simulator.nuisances())
        all.append(py::make_tuple(nuisance.name, nuisance.sigma));
    return all;
}

py::list outside_rows() {
    py::list rows;
    for (const OutsideEffect& effect : outside_effects())
        rows.append(py::make_tuple(effect.name, effect.low, effect.high, effect.both_signs));
    return rows;
}

}  // namespace

void bind_case_simulator(py::module_& module) {
    py::class_<CaseSimulator>(module, "CaseSimulator", "Simulates experiments with hidden effects.")
        .def(py::init([](const Scene& scene, const std::array<double, 4>& m, const std::string& device) {
                 return std::make_unique<CaseSimulator>(scene, Measurement{m[0], m[1], m[2], m[3]}, device);
             }),
             py::arg("scene"), py::arg("measurement"), py::arg("device"))
        .def("effects", &effects_of)
        .def("nuisances", &nuisances_of)
        .def(
            "make_packings",
            [](CaseSimulator& s, const std::vector<std::uint64_t>& seeds) {
                watched(py::none(), [&](const auto& p) { return s.make_packings(seeds, p.stop_wanted), 0; });
            },
            py::arg("seeds"))
        .def("at_once", &CaseSimulator::at_once)
        .def(
            "simulate",
            [](CaseSimulator& s, const std::vector<CaseTuple>& rows, bool loading, py::object progress) {
                std::vector<SimulatedCase> cases;
                for (const auto& [folder, hidden, shifts, packing, seed] : rows)
                    cases.push_back({folder, hidden, shifts, packing, seed});
                return watched(std::move(progress),
                               [&](const auto& p) { return s.simulate(cases, loading, p); });
            },
            py::arg("cases"), py::arg("loading"), py::arg("progress") = py::none())
        .def(
            "measured",
            [](const CaseSimulator& s, std::size_t k) {
                return std::make_shared<Run>(Run{"", "", "", "", "", {s.measured(k)}});
            },
            py::arg("k"));
    module.def("outside_effects", &outside_rows,
               "Effects that no library has: name, smallest and largest amplitude, whether either sign.");
    module.def("derived_seed", &derived_seed, py::arg("seed"), py::arg("number"));
}

}  // namespace mcdem::python
