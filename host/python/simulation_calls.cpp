// mcdem.devices, simulate, run and read
#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "core/errors.h"
#include "core/version.h"
#include "ensemble/make_packings.h"
#include "ensemble/run_scene.h"
#include "io/results.h"
#include "python/bindings.h"
#include "python/watch.h"
#include "scene/read/scene_warnings.h"
#include "sim/batch_limits.h"

namespace mcdem::inline python {
namespace {

namespace py = pybind11;

py::list devices() {
    py::list all;
    for (const DeviceInfo& device : list_devices())
        all.append(
            py::dict(py::arg("index") = device.index, py::arg("name") = device.name,
                     py::arg("platform") = device.platform, py::arg("version") = device.version,
                     py::arg("gpu") = device.gpu, py::arg("double_precision") = device.double_precision,
                     py::arg("compute_units") = device.compute_units, py::arg("memory") = device.memory));
    return all;
}

std::string failure_text(const std::string& label, const Failure& failure) {
    return fmt::format("replica {} stopped at {}", label.empty() ? "1" : label, failure.text());
}

/// As in the program: a replica that stops is a warning; if all stop, it is an error.
void expect_one_alive(const SharedRun& run) {
    std::string causes;
    for (const Recording& recording : run->recordings) {
        if (!recording.failure) return;
        if (!causes.empty()) causes += '\n';
        causes += failure_text(recording.label, *recording.failure);
    }
    if (!causes.empty()) throw AllStopped(causes, run);
}

SharedRun simulate_scene(const Scene& scene, const std::string& choice, py::object progress) {
    Watch watch(std::move(progress));
    for (const std::string& warning : scene_warnings(scene)) watch.warn(warning);
    auto run = std::make_shared<Run>();
    try {
        const py::gil_scoped_release others_go_on;
        Device device(choice);
        expect_runnable(device, scene);
        *run = {
            scene.name, scene.text, version_text, device.description(), std::string(name(scene.precision)),
            {}};
        const Callbacks callbacks{[&](double part) { watch.show_progress(part); },
                                  [&] { return watch.stop_wanted(); }};
        run->recordings = simulate(device, scene, make_packings(scene, callbacks.stop_wanted), callbacks);
        for (const Recording& recording : run->recordings)
            if (recording.failure) watch.warn(failure_text(recording.label, *recording.failure));
    } catch (const Interrupted&) {
    }
    watch.raise();
    expect_one_alive(run);
    return run;
}

SharedRun run_into(const Scene& scene, const std::filesystem::path& folder, bool resume,
                   const std::string& choice, py::object progress) {
    Watch watch(std::move(progress));
    for (const std::string& warning : scene_warnings(scene)) watch.warn(warning);
    RunOptions options;
    options.folder = folder;
    options.start = resume ? Start::resume : Start::fresh;
    options.program = version_text;
    options.on_progress = [&](double part) { watch.show_progress(part); };
    options.on_failure = [&](const Replica& replica, const Failure& failure) {
        watch.warn(failure_text(replica.label, failure));
    };
    options.on_warning = [&](const std::string& message) { watch.warn(message); };
    options.stop_wanted = [&] { return watch.stop_wanted(); };
    auto run = std::make_shared<Run>();
    {
        const py::gil_scoped_release others_go_on;
        Device device(choice);
        if (run_scene(device, scene, options).end != RunEnd::interrupted) *run = read_run(folder);
    }
    watch.raise();
    expect_one_alive(run);
    return run;
}

ReadWhat what_of(const std::string& word) {
    if (word == "everything") return ReadWhat::everything;
    if (word == "observables") return ReadWhat::observables;
    if (word == "positions") return ReadWhat::positions;
    if (word == "contacts") return ReadWhat::contacts;
    throw InputError("what: must be one of everything, observables, positions, contacts; got " + word);
}

SharedRun read(const std::filesystem::path& path, const std::string& what) {
    const py::gil_scoped_release others_go_on;
    return std::make_shared<Run>(read_run(path, what_of(what)));
}

/// A run of one recording, with all its data.
SharedRun read_replica(const std::filesystem::path& path, std::size_t number) {
    return watched(py::none(), [&](const Callbacks& callbacks) {
        RunReader reader(path);
        auto run = std::make_shared<Run>(reader.run());
        if (number >= run->recordings.size())
            throw InputError(fmt::format("{}: has {} replicas, got number {}", path.string(),
                                         run->recordings.size(), number));
        Recording one = std::move(run->recordings[number]);
        for (std::size_t s = 0; s < one.scans.size(); ++s) {
            if (callbacks.stop_wanted()) throw Interrupted();
            one.scans[s] = reader.read_scan(number, s);
        }
        run->recordings.assign(1, std::move(one));
        return run;
    });
}

}  // namespace

void bind_simulation(py::module_& module) {
    module.def("devices", &devices,
               "The OpenCL devices that a run can use, in the order of `device` numbers.");
    module.def("simulate", &simulate_scene, py::arg("scene"), py::kw_only(), py::arg("device") = "",
               py::arg("progress") = py::none(),
               "Runs a scene in memory. `progress(fraction)` is called after every round.\n\n"
               "If all replicas stop early, the RuntimeError has what they recorded until then as `run`.");
    module.def("run", &run_into, py::arg("scene"), py::arg("folder"), py::kw_only(),
               py::arg("resume") = false, py::arg("device") = "", py::arg("progress") = py::none(),
               "Runs a scene into a folder, as `mcdem run` does, and returns its results.\n\n"
               "After Ctrl-C, or an exception of `progress(fraction)`, the run can be continued with "
               "resume=True.");
    module.def("read_replica", &read_replica, py::arg("path"), py::arg("number"),
               "One recording of a result folder or file.");
    module.def("read", &read, py::arg("path"), py::kw_only(), py::arg("what") = "everything",
               "A result folder or file. `what`: everything, positions, contacts or observables (neither).");
}

}  // namespace mcdem::python
