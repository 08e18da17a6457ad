// mcdem.diagnose, mcdem.converge
#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <variant>

#include "core/errors.h"
#include "core/output_file.h"
#include "core/version.h"
#include "diagnose/decide/diagnosis_json.h"
#include "diagnose/infer/convergence_json.h"
#include "ensemble/converge_scene.h"
#include "ensemble/diagnosis/diagnose_experiment.h"
#include "io/result_folder.h"
#include "python/bindings.h"
#include "python/watch.h"

namespace mcdem::inline python {
namespace {

namespace py = pybind11;

void check(const DiagnoseOptions& options) {
    std::vector<std::string> problems;
    const auto expect = [&](const char* name, int value, int least) {
        if (value < least)
            problems.push_back(fmt::format("{}: must be {} or more, got {}", name, least, value));
    };
    expect("replicates", options.replicates, 8);
    expect("pairs", options.pairs, 2);
    expect("confirmations", options.confirmations, 0);
    if (!(options.refine >= 1 && options.refine <= 64))
        problems.push_back(fmt::format("refine: must be between 1 and 64, got {}", options.refine));
    if (!problems.empty()) throw InputError(problems);
}

using Path = std::filesystem::path;
using OneOrSeveral = std::variant<Path, std::vector<Path>>;

py::object diagnose(const Scene& scene, const OneOrSeveral& experiment, const Path& folder,
                    const std::vector<std::string>& candidates, int replicates, int pairs, int confirmations,
                    double refine, std::uint64_t seed, std::optional<Path> library, const std::string& choice,
                    py::object progress) {
    Watch watch(std::move(progress));
    DiagnoseOptions options;
    options.folder = folder;
    options.candidates = candidates;
    options.replicates = replicates;
    options.pairs = pairs;
    options.confirmations = confirmations;
    options.refine = refine;
    options.seed = seed;
    options.library = std::move(library);
    options.program = version_text;
    options.on_progress = [&](const std::string& stage, double part) { watch.show_progress(stage, part); };
    options.on_note = [&](const std::string& note) { watch.warn(note); };
    options.stop_wanted = [&] { return watch.stop_wanted(); };
    check(options);
    return json_result(watch, [&] {
        const Path* one = std::get_if<Path>(&experiment);
        const std::vector<Experiment> measured =
            read_experiments(one ? std::vector{*one} : std::get<std::vector<Path>>(experiment), "experiment");
        const FolderLock lock = open_output_folder(folder);
        Device device(choice);
        const Diagnosis diagnosis = diagnose_experiment(device, scene, measured, options);
        const std::string text = diagnosis_json(diagnosis);
        replace_own(folder / "diagnosis.json", FileKind::diagnosis, text);
        return text;
    });
}

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

void bind_diagnosis(py::module_& module) {
    module.def(
        "diagnose", &diagnose, py::arg("scene"), py::arg("experiment"), py::arg("folder"), py::kw_only(),
        py::arg("candidates") = std::vector<std::string>{}, py::arg("replicates") = 32, py::arg("pairs") = 8,
        py::arg("confirmations") = 8, py::arg("refine") = 4.0, py::arg("seed") = 1,
        py::arg("library") = py::none(), py::arg("device") = "", py::arg("progress") = py::none(),
        "Where a scene and an experiment differ, and which effect is consistent with the difference: "
        "the contents of diagnosis.json as a dict.\n`experiment`: a folder, or a list of those of "
        "several packings, which "
        "are diagnosed together. `refine`: the largest factor by which a scene that is not converged "
        "is refined, "
        "1: not at all.\n\n"
        "Writes diagnosis.json into `folder`, as `mcdem diagnose` does; simulations "
        "are\nkept there, so that the same call continues after an interruption by Ctrl-C. "
        "`progress(stage, fraction)` is called\nrepeatedly. host/diagnose/DIAGNOSIS_OUTPUT.md explains "
        "the keys.");
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
