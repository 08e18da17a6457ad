#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "python/bindings.h"
#include "python/toml_text.h"
#include "scene/read_scene.h"

namespace mcdem::inline python {
namespace {

namespace py = pybind11;

Scene scene_of(const py::dict& tables, const py::kwargs& more) {
    py::dict all;
    for (const auto& [key, value] : tables) all[key] = value;
    for (const auto& [key, value] : more) all[key] = value;
    return parse_scene(toml_text(all), "scene");
}

std::vector<std::string> labels(const Scene& scene) {
    std::vector<std::string> all;
    for (const Replica& replica : scene.replicas) all.push_back(replica.label);
    return all;
}

py::list parameters(const Scene& scene) {
    py::list all;
    for (const Replica& replica : scene.replicas) all.append(typed_parameters(replica.parameters));
    return all;
}

}  // namespace

void bind_scene(py::module_& module) {
    py::class_<Scene>(
        module, "Scene",
        "What to simulate, checked: the replicas of one run.\n\n"
        "Scene(tables, **more) takes the keys of a scene (scenes/README.md), nested or dotted, in SI\n"
        "units: Scene(grains={'friction': 0.1}) or Scene({'grains.friction': 0.1}). ValueError lists\n"
        "every problem.")
        .def(py::init(&scene_of), py::arg("tables") = py::dict(), py::pos_only())
        .def_static(
            "read",
            [](const std::filesystem::path& file, const py::dict& set) {
                return read_scene(file, overrides_of(set));
            },
            py::arg("file"), py::kw_only(), py::arg("set") = py::dict(),
            "A scene file (TOML); `set` overrides keys of it.")
        .def_static(
            "parse",
            [](const std::string& text, const py::dict& set) {
                return parse_scene(text, "scene", overrides_of(set));
            },
            py::arg("text"), py::kw_only(), py::arg("set") = py::dict(),
            "A scene from TOML text. Packing files are relative to the working folder.")
        .def_readonly("name", &Scene::name, "What results are called.")
        .def_readonly("text", &Scene::text, "TOML, with what was overridden: what results keep.")
        .def_property_readonly("labels", &labels, "Label of each replica; [replicas].")
        .def_property_readonly("parameters", &parameters,
                               "Every key and its value, by replica; None where the key does not apply.")
        .def("__len__", [](const Scene& scene) { return scene.replicas.size(); })
        .def(py::pickle([](const Scene& scene) { return py::make_tuple(scene.name, scene.text); },
                        [](const py::tuple& state) {
                            return parse_scene(state[1].cast<std::string>(),
                                               state[0].cast<std::string>() + ".toml", {});
                        }))
        .def("__repr__", [](const Scene& scene) {
            return "<mcdem.Scene " + scene.name + ": " + std::to_string(scene.replicas.size()) + " replica" +
                   (scene.replicas.size() == 1 ? ">" : "s>");
        });
}

}  // namespace mcdem::python
