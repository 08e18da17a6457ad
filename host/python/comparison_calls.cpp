// mcdem.compare and calibrate
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "core/errors.h"
#include "core/version.h"
#include "ensemble/calibrate_scene.h"
#include "ensemble/reference.h"
#include "metrics/compare.h"
#include "python/bindings.h"
#include "python/watch.h"

namespace mcdem::inline python {
namespace {

namespace py = pybind11;

/// A run object, or the run at a path.
SharedRun reference_of(const py::object& reference, int discard, ReadWhat what) {
    if (py::isinstance<Run>(reference)) return reference.cast<SharedRun>();
    std::filesystem::path path;
    try {
        path = reference.cast<std::filesystem::path>();
    } catch (const py::cast_error&) {
        throw py::type_error("the reference must be a Run, or the path of a result or an experiment");
    }
    const py::gil_scoped_release others_go_on;
    return std::make_shared<Run>(read_reference(path, discard, what));
}

py::object value(double number) {
    return std::isfinite(number) ? py::object(py::float_(number)) : py::none();
}

py::dict dict_of(const Comparison& c) {
    py::dict all(py::arg("setting") = c.setting, py::arg("replicas") = c.replicas);
    const auto add = [&](const char* name, const Estimate& estimate) {
        all[name] = value(estimate.value);
        all[(std::string(name) + "_standard_error").c_str()] = value(estimate.standard_error);
    };
    add("Rtop", c.Rtop), add("errf", c.errf), add("errZ", c.errZ), add("bhat", c.bhat), add("tau", c.tau);
    all["notes"] = c.notes;
    return all;
}

py::list compare_run(const SharedRun& run, const py::object& reference, const std::string& setting,
                     int discard, std::optional<double> touch_force) {
    const SharedRun other = reference_of(reference, discard, ReadWhat::contacts);
    std::vector<Comparison> comparisons;
    {
        const py::gil_scoped_release others_go_on;
        const auto against = chosen_setting(*other, setting, other->name, "setting").replicas;
        for (const auto& one : group_by_setting(*run))
            comparisons.push_back(compare(one, against, touch_force));
    }
    py::list all;
    for (const auto& comparison : comparisons) all.append(dict_of(comparison));
    return all;
}

py::object calibrate(const Scene& scene, const py::object& reference, const std::string& setting, int discard,
                     double low, double high, double tolerance, int batch, int rounds,
                     const std::string& model, const std::string& choice, py::object progress) {
    const SharedRun other = reference_of(reference, discard, ReadWhat::observables);
    Watch watch(std::move(progress));
    CalibrateOptions options{
        calibrated_model(model, "calibrate: model"), {low, high}, {tolerance, batch, rounds, "gamma"}};
    options.on_progress = [&](int round, double part) {
        watch.show_progress((round + part) / rounds);
        if (watch.stop_wanted()) throw Interrupted();
    };
    options.on_note = [&](const std::string& note) { watch.warn(note); };
    return json_result(watch, [&] {
        Device device(choice);
        const Setting chosen = chosen_setting(*other, setting, other->name, "setting");
        return calibration_json(calibrate_scene(device, scene, chosen.replicas, options), options.model,
                                scene, chosen.label, version_text);
    });
}

}  // namespace

void bind_comparison(py::module_& module) {
    module.def(
        "compare", &compare_run, py::arg("run").none(false), py::arg("reference"), py::kw_only(),
        py::arg("setting") = "", py::arg("discard") = 0, py::arg("touch_force") = py::none(),
        "The paper's metrics of every setting of a run against a reference, one dict per setting, as `mcdem "
        "compare`\nprints them: Rtop, errf [N], errZ, bhat and tau [N] with standard errors, None where not "
        "known.\n`reference`: a run, a result folder, or the folder of an experiment; `setting` chooses one "
        "of a run's.");
    module.def("calibrate", &calibrate, py::arg("scene"), py::arg("reference"), py::kw_only(),
               py::arg("setting") = "", py::arg("discard") = 0,
               py::arg("low") = CalibrateOptions{}.bracket.low,
               py::arg("high") = CalibrateOptions{}.bracket.high,
               py::arg("tolerance") = CalibrationOptions{}.tolerance,
               py::arg("batch") = CalibrationOptions{}.batch, py::arg("rounds") = CalibrationOptions{}.rounds,
               py::arg("model") = "mc_dem", py::arg("device") = "", py::arg("progress") = py::none(),
               "The gamma of MC-DEM that gives the reference's top force, or the grains' Young's modulus for "
               "another model,\nas `mcdem calibrate` finds it; keys of the dict as in calibration.json.");
}

}  // namespace mcdem::python
