// mcdem._engine.programme_parameters, .programme_text and .scan_places: programmes of experiments, with the
// rules of a scene's.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <set>
#include <sstream>

#include "python/bindings.h"
#include "scene/programme/programme_text.h"
#include "scene/read/list_tables.h"
#include "scene/read/problems.h"
#include "scene/read/scene_checks.h"
#include "scene/read/toml_text.h"

namespace mcdem::inline python {
namespace {

namespace py = pybind11;
using NamedProblem = std::pair<std::string, std::string>;  // key; "must be .., got .."

/// Keys of one stage and their values as TOML.
void read_stage(const KeyValues& stage, int number, Settings& settings, std::set<std::string>& said,
                std::vector<NamedProblem>& problems) {
    element(settings.replica.programme, static_cast<std::size_t>(number));
    for (const auto& [field, text] : stage) {
        const std::string name = fmt::format("programme.{}.{}", number + 1, field);
        const Key* key = find_key(name);
        const auto value = parse_value(text);
        said.insert(name);
        if (!key || !value)
            problems.emplace_back(name, "must be a key of a stage, got an unknown one" + suggestion(name));
        else if (const auto wrong = assign(*key, *value->get("value"), settings))
            problems.emplace_back(name, *wrong);
    }
}

py::tuple programme_parameters_of(const std::vector<KeyValues>& stages, const std::string& name,
                                  const std::string& shape, const std::pair<double, double>& size,
                                  double plate_start) {
    std::vector<NamedProblem> problems;
    std::set<std::string> said;
    Settings settings;
    for (std::size_t n = 0; n < stages.size(); ++n)
        read_stage(stages[n], static_cast<int>(n), settings, said, problems);
    ParameterTexts parameters;
    if (problems.empty()) {
        settings.packing_file = name;  // the grains exist, so nothing is generated
        settings.replica.box = {size.first, size.second, *parse<ContainerShape>(shape)};
        settings.replica.plate = {plate_start, 0};
        for (const CrossProblem& found : programme_problems(settings, said, {}))
            problems.emplace_back(found.key, found.what);
        if (problems.empty()) parameters = parameter_texts(programme_parameters(settings.replica.programme));
    }
    return py::make_tuple(parameters, problems);
}

std::string programme_text(const ParameterTexts& parameters) {
    std::stringstream text;
    if (const auto stages = programme_of(parameters_of(parameters)); !stages.empty())
        text << toml::table{{"programme", programme_tables(stages)}};
    return text.str();
}

py::list places_of(const ParameterTexts& parameters, double plate_start) {
    py::list places;
    for (const ScanPlace& place : scan_places(programme_of(parameters_of(parameters)), {plate_start, 0}))
        places.append(py::dict(py::arg("stage") = place.stage, py::arg("leg") = place.leg,
                               py::arg("held") = place.held, py::arg("at_end") = place.at_end,
                               py::arg("by") = name(place.by), py::arg("set") = place.set,
                               py::arg("time") = place.time));
    return places;
}

}  // namespace

void bind_programmes(py::module_& module) {
    module.def(
        "programme_parameters", &programme_parameters_of, py::arg("stages"), py::arg("name"),
        py::arg("shape"), py::arg("size"), py::arg("plate_start"),
        "The parameters of a programme from the keys of its stages, with their values as TOML, and all "
        "problems: key, what it must be.");
    module.def("programme_text", &programme_text, py::arg("parameters"),
               "The [[programme]] tables of a recording's parameters, as TOML.");
    module.def("scan_places", &places_of, py::arg("parameters"), py::arg("plate_start"),
               "The place of each scan but the first in the programme of a recording's parameters.");
}

}  // namespace mcdem::python
