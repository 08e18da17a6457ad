// mcdem.converge
#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "core/errors.h"
#include "core/output_file.h"
#include "core/version.h"
#include "diagnose/convergence_json.h"
#include "ensemble/converge_scene.h"
#include "io/result_folder.h"
#include "python/bindings.h"
#include "python/watch.h"

namespace mcdem::inline python {
namespace {

namespace py = pybind11;

py::object converge(const Scene& scene, const std::filesystem::path& folder, int replicas, double force_limit,
                    double sd_limit, double jitter, std::uint64_t seed, const std::string& choice,
                    py::object progress) {
    if (replicas < 8) throw InputError(fmt::format("replicas: must be 8 or more, got {}", replicas));
    Watch watch(std::move(progress));
    ConvergeOptions options;
    options.folder = folder;
    options.replicas = replicas;
    options.jitter = jitter;
    options.seed = seed;
    options.limits = {force_limit, sd_limit};
    options.program = version_text;
    options.on_progress = [&](const std::string& cause, double part) { watch.show_progress(cause, part); };
    options.stop_wanted = [&] { return watch.stop_wanted(); };
    return json_result(watch, [&] {
        const FolderLock lock = open_output_folder(folder);
        Device device(choice);
        const std::string text = convergence_json(converge_scene(device, scene, options));
        replace_own(folder / "convergence.json", FileKind::convergence, text);
        return text;
    });
}

}  // namespace

void bind_convergence(py::module_& module) {
    module.def(
        "converge", &converge, py::arg("scene"), py::arg("folder"), py::kw_only(), py::arg("replicas") = 32,
        py::arg("force_limit") = ConvergenceLimits{}.force,
        py::arg("sd_limit") = ConvergenceLimits{}.deviations, py::arg("jitter") = 0.0, py::arg("seed") = 1,
        py::arg("device") = "", py::arg("progress") = py::none(),
        "How plate speed, inertia, time step, settling, precision and list margin change the observables of "
        "a\n"
        "scene's first replica: the contents of convergence.json as a dict. `mcdem converge --help` explains "
        "the method.");
}

}  // namespace mcdem::python
