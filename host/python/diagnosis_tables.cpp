// mcdem._engine.effects and .observables: the tables of the diagnosis.
#include <pybind11/stl.h>

#include "diagnose/effects.h"
#include "diagnose/observe/scan_observables.h"
#include "python/bindings.h"

namespace mcdem::inline python {
namespace {

namespace py = pybind11;

py::list effect_rows() {
    py::list rows;
    for (const Effect& effect : effects())
        rows.append(py::dict(
            py::arg("name") = effect.name, py::arg("words") = effect.words, py::arg("unit") = effect.unit,
            py::arg("formula") = effect.formula, py::arg("source") = effect.source,
            py::arg("low") = effect.low, py::arg("high") = effect.high, py::arg("first") = effect.first,
            py::arg("second") = effect.second, py::arg("numerical") = is_numerical(effect.name),
            py::arg("depends_on_speed") = depends_on_speed(effect.name)));
    return rows;
}

const char* name_of(Needs needs) {
    switch (needs) {
        case Needs::plate:
            return "plate";
        case Needs::contacts:
            return "contacts";
        case Needs::positions:
            return "positions";
        case Needs::programme:
            break;
    }
    return "programme";
}

py::list observable_rows() {
    py::list rows;
    for (const Observable& observable : observables())
        rows.append(py::dict(
            py::arg("name") = observable.name, py::arg("needs") = name_of(observable.needs),
            py::arg("resolution") = observable.resolution, py::arg("region") = observable.region,
            py::arg("force_class") = observable.force_class, py::arg("meaning") = observable.meaning));
    return rows;
}

}  // namespace

void bind_diagnosis_tables(py::module_& module) {
    module.def("effects", &effect_rows, "The candidate effects, in the order of the documentation.");
    module.def("observables", &observable_rows, "The observables, in the order of an observation's entries.");
}

}  // namespace mcdem::python
