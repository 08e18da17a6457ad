// mcdem._engine.Simulations: what a diagnosis simulates (ensemble/diagnosis/simulations.h).
#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "core/errors.h"
#include "core/version.h"
#include "ensemble/diagnosis/simulations.h"
#include "python/bindings.h"
#include "python/grid_dict.h"
#include "python/watch.h"

namespace mcdem::inline python {
namespace {

namespace py = pybind11;
namespace fs = std::filesystem;

PlanOptions plan_options(const std::vector<std::string>& candidates, int replicates, int pairs,
                         std::uint64_t seed, bool recordings) {
    PlanOptions options;
    options.candidates = candidates;
    options.replicates = replicates;
    options.pairs = pairs;
    options.seed = seed;
    options.with_recordings = recordings;
    options.program = version_text;
    return options;
}

std::unique_ptr<Simulations> of_experiments(const Scene& scene, const std::vector<Experiment>& experiments,
                                            const fs::path& store, const std::vector<std::string>& candidates,
                                            int replicates, int pairs, std::uint64_t seed, bool recordings,
                                            const std::string& device, const py::function& note) {
    std::vector<std::string> notes;
    std::unique_ptr<Simulations> simulations;
    {
        const py::gil_scoped_release others_go_on;
        PlanOptions options = plan_options(candidates, replicates, pairs, seed, recordings);
        options.on_note = [&](const std::string& text) { notes.push_back(text); };
        simulations = std::make_unique<Simulations>(plan_of(scene, experiments, options), store, device);
    }
    for (const std::string& text : notes) note(text);
    return simulations;
}

std::unique_ptr<Simulations> of_others(const Scene& scene, const Experiment& experiment, int packings,
                                       const fs::path& store, const std::vector<std::string>& candidates,
                                       int replicates, int pairs, std::uint64_t seed,
                                       const std::string& device) {
    return watched(py::none(), [&](const Callbacks& options) {
        return std::make_unique<Simulations>(
            plan_of_others(scene, experiment, packings,
                           plan_options(candidates, replicates, pairs, seed, false), options.stop_wanted),
            store, device);
    });
}

py::dict facts(const Simulations& simulations) {
    const DiagnosisPlan& plan = simulations.plan();
    const Model& model = plan.library.packings.front().model;
    py::list candidates, nuisances, probes, names;
    for (const std::string& name : plan.choice.chosen) {
        const Effect& effect = *find_effect(name);
        const double scale = effect.scale(model);
        const bool slower = name == "plate_speed" && model.experiment_speed;
        const double high =
            slower ? 1 - *model.experiment_speed / model.replica.plate.speed : effect.high * scale;
        candidates.append(py::make_tuple(name, effect.unit, effect.low * scale, high));
    }
    for (const Nuisance& nuisance : plan.library.nuisances)
        nuisances.append(py::make_tuple(nuisance.name, nuisance.unit, nuisance.sigma));
    for (const Probe& probe : probes_of(plan.library))
        probes.append(py::make_tuple(probe.name, probe.amplitudes[0], probe.amplitudes[1]));
    for (const Experiment& experiment : plan.experiments) names.append(experiment.name);
    return py::dict(
        py::arg("names") = names, py::arg("packings") = plan.library.packings.size(),
        py::arg("replicates") = plan.library.replicates, py::arg("candidates") = candidates,
        py::arg("hindered") = plan.choice.hindered, py::arg("nuisances") = nuisances,
        py::arg("probes") = probes, py::arg("paired_rows") = paired_trials(plan.library),
        py::arg("has_programme") = !model.replica.programme.empty(),
        py::arg("other_materials") = other_materials(model.replica, plan.experiments.front().materials));
}

using Change = std::tuple<std::string, std::string, double, double>;
Change tuple_of(const SettingChange& change) { return {change.key, change.unit, change.from, change.to}; }

std::vector<Change> tuples(const std::vector<SettingChange>& changes) {
    std::vector<Change> all;
    for (const SettingChange& change : changes) all.push_back(tuple_of(change));
    return all;
}

void bind_runs(py::class_<Simulations>& type) {
    using Runs = Eigen::MatrixXd (Simulations::*)(const Callbacks&);
    for (const auto& [name, runs] : {std::pair<const char*, Runs>{"library", &Simulations::library},
                                     {"baseline", &Simulations::baseline},
                                     {"finer_baseline", &Simulations::finer_baseline}})
        type.def(
            name,
            [runs = runs](Simulations& s, py::object progress) {
                return watched(std::move(progress), [&](const auto& p) { return (s.*runs)(p); });
            },
            py::arg("progress") = py::none());
    type.def(
            "fitted",
            [](Simulations& s, const std::vector<Amplitudes>& fits, int runs,
               std::optional<std::size_t> protocol, py::object progress) {
                return watched(std::move(progress),
                               [&](const auto& p) { return s.fitted(fits, runs, protocol, p); });
            },
            py::arg("fits"), py::arg("runs"), py::arg("protocol") = py::none(),
            py::arg("progress") = py::none())
        .def(
            "record",
            [](Simulations& s, const Amplitudes& fit, int runs, py::object progress) {
                watched(std::move(progress), [&](const auto& p) { return s.record(fit, runs, p), 0; });
            },
            py::arg("fit"), py::arg("runs"), py::arg("progress") = py::none())
        .def(
            "compute_part",
            [](Simulations& s, std::size_t part, py::object progress) {
                watched(std::move(progress), [&](const auto& p) { return s.compute_part(part, p), 0; });
            },
            py::arg("part"), py::arg("progress") = py::none());
}

void bind_settings(py::class_<Simulations>& type) {
    type.def(
            "setting", [](Simulations& s, const std::string& effect) { return tuple_of(s.setting(effect)); },
            py::arg("effect"))
        .def("refine", &Simulations::refine, py::arg("effect"), py::arg("factor"))
        .def(
            "neglected_motion",
            [](const Simulations& s, double slowdown) { return tuples(s.neglected_motion(slowdown)); },
            py::arg("max_slowdown"))
        .def("follow_motion", &Simulations::follow_motion, py::arg("max_slowdown"))
        .def("other_protocols", &Simulations::other_protocols, py::arg("slower"))
        .def("changed_keys", &Simulations::changed_keys, py::arg("amplitudes"))
        .def(
            "recordings",
            [](Simulations& s, const Amplitudes& fit, int before, int after) {
                const auto run_of = [](std::vector<Recording> recordings) {
                    return std::make_shared<Run>(Run{"", "", "", "", "", std::move(recordings)});
                };
                return py::make_tuple(run_of({s.plan().experiments.front().recording}),
                                      run_of(s.recordings({}, before)), run_of(s.recordings(fit, after)));
            },
            py::arg("fit"), py::arg("before"), py::arg("after"));
}

}  // namespace

void bind_simulations(py::module_& module) {
    py::class_<Simulations> type(module, "Simulations", "The simulations that a diagnosis asks for.");
    type.def(py::init(&of_experiments), py::arg("scene"), py::arg("experiments"), py::arg("store"),
             py::kw_only(), py::arg("candidates"), py::arg("replicates"), py::arg("pairs"), py::arg("seed"),
             py::arg("recordings"), py::arg("device"), py::arg("note"))
        .def_static("of_others", &of_others, py::arg("scene"), py::arg("experiment"), py::arg("packings"),
                    py::arg("store"), py::kw_only(), py::arg("candidates"), py::arg("replicates"),
                    py::arg("pairs"), py::arg("seed"), py::arg("device"))
        .def("facts", &facts)
        .def_property_readonly("device", [](Simulations& s) { return s.device(); })
        .def_property_readonly("device_name", [](Simulations& s) { return s.device_name(); })
        .def_property_readonly("origin", &Simulations::origin)
        .def_property(
            "grid", [](const Simulations& s) { return dict_of(s.plan().common.grid); },
            [](Simulations& s, const py::dict& grid) { s.compare_at(grid_from(grid)); })
        .def("observed", &Simulations::observed)
        .def_property_readonly("causes_of_failure", &Simulations::causes_of_failure)
        .def("count_parts", &Simulations::count_parts)
        .def("missing_parts", &Simulations::missing_parts, py::arg("device"));
    bind_runs(type);
    bind_settings(type);
}

}  // namespace mcdem::python
