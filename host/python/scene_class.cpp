#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "core/version.h"
#include "ensemble/parts/manifest.h"
#include "io/run_packing.h"
#include "python/bindings.h"
#include "scene/programme/legs.h"
#include "scene/read/change_scene.h"
#include "scene/read/keys.h"
#include "scene/read/read_scene.h"
#include "scene/read/scene_warnings.h"

namespace mcdem::inline python {
namespace {

namespace py = pybind11;

/// "key = value" for each entry of nested or dotted tables.
std::vector<std::string> assignments(const py::dict& tables) {
    return py::module_::import("mcdem.toml").attr("assignments")(tables).cast<std::vector<std::string>>();
}

Scene scene_of(const py::dict& tables, const py::kwargs& more) {
    py::dict all;
    all.attr("update")(tables, **more);
    return parse_scene(fmt::format("{}\n", fmt::join(assignments(all), "\n")), "scene", {},
                       read_packing_or_run);
}

/// Inverse of python_text.
std::string text_of(const py::handle& text) {
    return py::module_::import("os").attr("fsencode")(text).cast<std::string>();
}

struct ToPython {
    py::object operator()(std::monostate) const { return py::none(); }
    py::object operator()(const std::string& text) const { return python_text(text); }
    py::object operator()(const std::vector<double>& values) const {
        return python_text(parameter_text(values));
    }
    py::object operator()(double value) const {
        return is_written_whole(value) ? py::object(py::int_(static_cast<std::int64_t>(value)))
                                       : py::object(py::float_(value));
    }
    template <class Value>
    py::object operator()(Value value) const {
        return py::cast(value);
    }
};

std::vector<std::string> labels(const Scene& scene) {
    std::vector<std::string> all;
    for (const Replica& replica : scene.replicas) all.push_back(replica.label);
    return all;
}

py::list parameters(const Scene& scene) {
    py::list all;
    for (const Replica& replica : scene.replicas) all.append(parameter_dict(replica.parameters));
    return all;
}

}  // namespace

py::str python_text(const std::string& text) {
    return py::reinterpret_steal<py::str>(
        PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), "surrogateescape"));
}

py::dict parameter_dict(const Parameters& parameters) {
    py::dict all;
    for (const auto& [key, value] : parameters) all[py::str(key)] = std::visit(ToPython{}, value);
    return all;
}

KeyValues key_values(const py::dict& values) {
    const py::object text_of = py::module_::import("mcdem.toml").attr("value_text");
    KeyValues texts;
    for (const auto& [key, value] : values)
        texts[key.cast<std::string>()] = text_of(key, value).cast<std::string>();
    return texts;
}

namespace {

/// What a diagnosis changes of a scene.
void bind_variants(py::class_<Scene>& type) {
    type.def_property_readonly(
            "_texts",
            [](const Scene& scene) {
                py::dict all;
                for (const auto& [key, value] : values_of_keys(scene))
                    all[py::str(key)] = python_text(parameter_text(value));
                return all;
            },
            "Every key of the first replica with its value as text, in the order of the reference.")
        .def_property_readonly(
            "_values",
            [](const Scene& scene) {
                const auto values = values_of_keys(scene);
                return parameter_dict({values.begin(), values.end()});
            },
            "The same as numbers, truths and texts; None for what is not given.")
        .def(
            "_changed",
            [](const Scene& scene, const py::dict& values) {
                return with_changes(scene, key_values(values));
            },
            py::arg("values"),
            "All replicas with other values of keys, checked, on the packings that they have.")
        .def(
            "_variant",
            [](const Scene& scene, const py::dict& values) { return variant_of(scene, key_values(values)); },
            py::arg("values"), "The first replica with other values of keys, without checks of ranges.")
        .def(
            "_with_programme",
            [](const Scene& scene, const ParameterTexts& parameters) {
                return with_programme(scene, parameters_of(parameters));
            },
            py::arg("parameters"), "With the programme of a recording's parameters; none: strokes.")
        .def("_with_box", [](const Scene& scene, const std::string& shape, double size_x, double size_y) {
            const auto known = parse<ContainerShape>(shape);
            if (!known) throw py::value_error("shape: must be that of a container, got " + shape);
            Scene changed = scene;
            for (Replica& replica : changed.replicas) replica.box = {size_x, size_y, *known};
            return changed;
        });
}

void bind_keys(py::module_& module) {
    module.def(
        "key_unit",
        [](const std::string& name) {
            const Key* key = find_key(name);
            if (!key) throw py::key_error(name);
            return std::string(key->unit);
        },
        py::arg("key"));
    module.def(
        "key_range",
        [](const std::string& name) -> py::object {
            const Key* key = find_key(name);
            if (!key || !std::holds_alternative<MemberOf<double>>(key->member)) return py::none();
            return py::make_tuple(key->range.low, key->range.high,
                                  key->range.low_end == Range::Low::excluded);
        },
        py::arg("key"));
}

}  // namespace

void bind_scene(py::module_& module) {
    py::class_<Scene> type(
        module, "Scene",
        "What to simulate, checked: the replicas of one run.\n\n"
        "Scene(tables, **more) takes the keys of a scene (scenes/README.md), nested or dotted, in SI\n"
        "units: Scene(grains={'friction': 0.1}) or Scene({'grains.friction': 0.1}). ValueError lists\n"
        "every problem.");
    bind_variants(type);
    type.def(py::init(&scene_of), py::arg("tables") = py::dict(), py::pos_only())
        .def_static(
            "read",
            [](const std::filesystem::path& file, const py::dict& set) {
                return read_scene(file, assignments(set), read_packing_or_run);
            },
            py::arg("file"), py::kw_only(), py::arg("set") = py::dict(),
            "A scene file (TOML); `set` overrides keys of it.")
        .def_static(
            "parse",
            [](const py::str& text, const py::dict& set) {
                return parse_scene(text_of(text), "scene", assignments(set), read_packing_or_run);
            },
            py::arg("text"), py::kw_only(), py::arg("set") = py::dict(),
            "A scene from TOML text. Packing files are relative to the working folder.")
        .def_property_readonly(
            "name", [](const Scene& scene) { return python_text(scene.name); }, "What results are called.")
        .def_property_readonly(
            "text", [](const Scene& scene) { return python_text(scene.text); },
            "TOML, with what was overridden: what results keep.")
        .def_property_readonly("labels", &labels, "Label of each replica; [replicas].")
        .def_property_readonly("parameters", &parameters,
                               "Every key and its value, by replica; None where the key does not apply.")
        .def("__len__", [](const Scene& scene) { return scene.replicas.size(); })
        .def(py::pickle(
            [](const Scene& scene) {
                return py::make_tuple(python_text(scene.name), python_text(scene.text));
            },
            [](const py::tuple& state) {
                return parse_scene(text_of(state[1]), text_of(state[0]) + ".toml", {}, read_packing_or_run);
            }))
        .def("__repr__", [](const Scene& scene) {
            return "<mcdem.Scene " + scene.name + ": " + std::to_string(scene.replicas.size()) + " replica" +
                   (scene.replicas.size() == 1 ? ">" : "s>");
        });
    module.def(
        "scene_of_options",
        [](const std::filesystem::path& file, const std::vector<py::str>& overrides) {
            std::vector<std::string> texts;
            for (const py::str& one : overrides) texts.push_back(text_of(one));
            Scene scene = read_scene(file, texts, read_packing_or_run);
            const auto warnings = scene_warnings(scene);
            return py::make_tuple(std::move(scene), warnings);
        },
        py::arg("file"), py::arg("overrides"),
        "A scene file with overrides \"key=value\", and warnings about its packing files.");
    module.def("expect_plate", &expect_plate, py::arg("scene"), py::arg("what"),
               "Refuses cells and species, which `what` does not support.");
    bind_keys(module);
    module.def("expect_plain_strokes", &expect_plain_strokes, py::arg("scene"), py::arg("what"),
               "Refuses cells, species and programmes, which `what` does not support.");
    module.def(
        "manifest_of", [](const Scene& scene) { return manifest_of(scene, version_text); }, py::arg("scene"),
        "Everything but the device that determines the bits of a run: names and digests.");
}

}  // namespace mcdem::python
