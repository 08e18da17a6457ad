#include "challenge/run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "challenge/files.h"
#include "challenge/results.h"
#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/input_file.h"
#include "core/look.h"
#include "core/make_folder.h"
#include "core/output_file.h"
#include "core/sha256.h"
#include "ensemble/diagnosis/library_origin.h"
#include "ensemble/make_packings.h"
#include "ensemble/parts/manifest.h"
#include "io/folder_lock.h"
#include "io/result_folder.h"
#include "scene/programme/legs.h"
#include "scene/random.h"

namespace mcdem::inline challenge {
namespace {

namespace fs = std::filesystem;

const char* const evidence_folder = answers_folder;
const char* const findings_folder = "findings";
fs::path case_file(const fs::path& folder, const OpenCase& c) { return folder / (c.folder + ".json"); }

std::size_t grains_of(const Experiment& experiment) { return experiment.recording.diameter.size(); }

/// Locks the folder, and then checks its content.
FolderLock lock_folder(const fs::path& out, FolderLock::Use use) {
    expect_no_experiment(out);
    make_result_folder(out);
    FolderLock lock(out, use);
    if (const fs::path file = file_of_a_run(out); !file.empty())
        throw InputError(
            fmt::format("{}: holds a run ({}): give another folder for the diagnoses of a challenge",
                        out.string(), file.filename().string()));
    return lock;
}

class ChallengeParts : public PartedWork {
public:
    ChallengeParts(const Scene& scene, const ChallengeRunOptions& options, FolderLock::Use use)
        : scene_(scene), options_(options), challenge_(read_open_challenge(options.challenge)) {
        if (Sha256().add(scene.text).hex() != challenge_.scene_sha256)
            throw InputError(fmt::format("{}: is not the scene that {} was made with", scene.name,
                                         (options.challenge / "challenge.json").string()));
        for (const OpenCase& c : challenge_.cases)
            if (!is_there(options.challenge / c.folder / "experiment.toml"))
                throw InputError(fmt::format("{}: {} is not made yet: continue with `mcdem challenge make`",
                                             options.challenge.string(), c.folder));
        lock_.emplace(lock_folder(options.out, use));
        expect_own_options();
        make_folder_of(options.library.file);  // before the library is computed
        remove_temporaries_of(options.library.file);
        for (const char* folder : {evidence_folder, findings_folder}) make_folder(options.out / folder);
        for (const char* folder : {"", "simulations", evidence_folder, findings_folder})
            remove_temporaries(options.out / folder);
    }

    std::size_t count() override { return challenge_.cases.size() + library_parts().size(); }

    /// Cases have the first numbers, but are computed last because they need the library.
    std::vector<std::size_t> missing() override {
        std::vector<std::size_t> parts;
        if (missing_cases().empty()) return parts;
        if (!is_there(options_.library.file)) {
            const auto kept = read_manifest(device_file(options_.out));
            for (std::size_t k = 0; k < library_parts().size(); ++k)
                if (!kept ||
                    !are_observed(kept->at(device_description), common(), library_parts()[k], store()))
                    parts.push_back(challenge_.cases.size() + k);
        }
        return parts.empty() ? missing_cases() : parts;
    }

    void compute(Device& device, std::size_t part) override {
        expect_device(device);
        if (part < challenge_.cases.size()) {
            const OpenCase& c = challenge_.cases[part];
            if (is_done(c)) return;
            make_library(device);
            return diagnose(device, c);
        }
        if (is_there(options_.library.file)) return;
        part -= challenge_.cases.size();
        observe_trials(device, common(), library_parts()[part], store(), trial_options());
    }

    bool merge() override { return missing_cases().empty(); }

    void all(Device& device) {
        const auto left = missing_cases();
        if (left.empty()) return;
        expect_device(device);
        const double library = is_there(options_.library.file) ? 0 : work_of_library();
        const double whole = library + work_a_case() * static_cast<double>(left.size());
        on_progress = [&](double fraction) { options_.on_progress(library * fraction / whole); };
        make_library(device);
        double before = library;
        on_progress = [&](double fraction) {
            options_.on_progress((before + work_a_case() * fraction) / whole);
        };
        for (const std::size_t c : left) {
            diagnose(device, challenge_.cases[c]);
            before += work_a_case();
        }
    }

private:
    static constexpr const char* device_description = "device";

    fs::path file_of(const OpenCase& c, const std::string& folder) const {
        return case_file(options_.out / folder, c);
    }
    bool is_done(const OpenCase& c) const { return is_there(file_of(c, "")); }
    std::vector<std::size_t> missing_cases() const {
        std::vector<std::size_t> cases;
        for (std::size_t c = 0; c < challenge_.cases.size(); ++c)
            if (!is_done(challenge_.cases[c])) cases.push_back(c);
        return cases;
    }

    /// Throws InputError if the answers in the folder were started with other options.
    void expect_own_options() const {
        Manifest wanted = manifest_of(scene_, options_.program);
        wanted["challenge"] = Sha256().add(read_file(options_.challenge / "challenge.json")).hex();
        const ChallengeLibrary& library = options_.library;
        for (const auto& [name, value] : {std::pair{"--replicates", options_.replicates},
                                          {"--confirmations", options_.confirmations},
                                          {"--library-packings", library.packings},
                                          {"--library-replicates", library.replicates},
                                          {"--library-pairs", library.pairs}})
            wanted[name] = std::to_string(value);
        wanted["--candidates"] = fmt::format("{}", fmt::join(library.candidates, ","));
        wanted["--seed"] = std::to_string(options_.seed);
        keep_manifest(manifest_file(options_.out), wanted);
    }
    void expect_device(const Device& device) const {
        keep_manifest(device_file(options_.out), {{device_description, device.description()}});
    }

    fs::path library_file() const { return options_.out / "library.json"; }
    /// Number of simulations, for the progress.
    double work_of_library() {
        double trials = 0;
        for (const auto& part : library_parts()) trials += static_cast<double>(part.size());
        return trials;
    }
    double work_a_case() const { return options_.replicates + 2.0 * options_.confirmations; }

    /// Other packings of the same kind. The seeds of the cases are not known here; a coincidence is
    /// improbable.
    std::vector<Packing> other_packings(const Replica& replica) const {
        constexpr std::uint64_t apart = 0x6c696272617279;
        Scene all = scene_;
        all.replicas.clear();
        for (int p = 0; p < options_.library.packings; ++p) {
            all.replicas.push_back(replica);
            all.replicas.back().packing.seed =
                scattered(scattered(options_.seed + apart) + static_cast<std::uint64_t>(p)) >> 16;
        }
        return make_packings(all, options_.stop_wanted);
    }

    /// The grid of an experiment with the plate positions of the scene, because the zero of strain of a case
    /// differs from that of the scene.
    Grid grid_of_scene(const Experiment& experiment) const {
        const Plate& plate = scene_.replicas.front().plate;
        Grid grid = grid_of(experiment.recording);
        const double factor = (plate.start - plate.end) / grid.stroke;
        for (double& displacement : grid.displacement) displacement *= factor;
        grid.width *= factor;
        grid.stroke *= factor;
        return grid;
    }

    /// The first case, whose experiment determines the library.
    const Experiment& first_experiment() {
        if (!first_)
            first_ = compared_cycles(scene_,
                                     read_experiment(options_.challenge / challenge_.cases.front().folder));
        return *first_;
    }

    TrialSettings common() { return trial_settings_of(first_experiment()); }

    TrialSettings trial_settings_of(const Experiment& experiment) const {
        const Model model = model_of(scene_, experiment);
        return {scene_, grid_of_scene(experiment), reference_material(model), model.replica.protocol.discard,
                options_.program};
    }

    Model library_model() {
        Model model = model_of(scene_, first_experiment());
        model.replica.plate = scene_.replicas.front().plate;
        return model;
    }

    const LibraryPlan& library_plan() {
        if (plan_) return *plan_;
        const Experiment& experiment = first_experiment();
        const Model model = library_model();
        LibraryPlan plan;
        for (Packing& packing : other_packings(model.replica))
            plan.packings.push_back({model, std::move(packing)});
        plan.replicates = options_.library.replicates;
        plan.pairs = options_.library.pairs;
        plan.jitter = experiment.measurement.position_error;
        plan.diameter_jitter = experiment.measurement.diameter_error;
        plan.seed = options_.seed;
        plan.candidates = choose_candidates(model, options_.library.candidates).chosen;
        plan.nuisances = nuisances(model, experiment);
        return plan_.emplace(std::move(plan));
    }

    const std::vector<std::vector<Trial>>& library_parts() {
        if (!library_parts_) library_parts_ = parts_of_trials(common(), library_trials(library_plan()));
        return *library_parts_;
    }

    ObservationStore store() const { return ObservationStore(options_.out / "simulations"); }

    TrialOptions trial_options() const { return {on_progress, options_.stop_wanted}; }

    /// Reads the library, or computes it for the measurement of the first case, and copies it to the results.
    /// Throws InputError if its origin differs, or the results belong to another one.
    void make_library(Device& device) {
        if (library_) return;
        const fs::path& file = options_.library.file;
        const Experiment& experiment = first_experiment();
        if (!is_there(file))  // another process may have written the same library in the meantime
            create_file(file, library_text(
                                  build_library(device, common(), library_plan(), store(), trial_options())));
        Library library = read_library(file);
        expect_origin(library, library_origin(common(), model_of(scene_, experiment), grains_of(experiment)),
                      file);
        const std::string text = library_text(library);
        if (!create_file(library_file(), text) && read_file(library_file()) != text)
            throw InputError(fmt::format(
                "{}: is another library than {}, and cases there were diagnosed with it: give that "
                "library, or another folder (--out)",
                library_file().string(), file.string()));
        library_ = std::move(library);
    }

    std::vector<std::string> candidates_of(const OpenCase& c) const {
        std::vector<std::string> names;
        for (const Signature& effect : library_->effects)
            if (!c.candidates || std::ranges::find(*c.candidates, effect.name) != c.candidates->end())
                names.push_back(effect.name);
        return names;
    }

    void diagnose(Device& device, const OpenCase& c) {
        DiagnoseOptions how;
        how.folder = options_.out;
        how.candidates = candidates_of(c);
        how.replicates = options_.replicates;
        how.confirmations = options_.confirmations;
        how.paper_metrics = false;  // not scored
        how.seed = options_.seed;
        how.library = library_file();
        how.program = options_.program;
        how.on_progress = [&](const std::string& stage, double fraction) {
            on_progress(stage == "baseline" ? 0.5 * fraction : 0.5 + 0.5 * fraction);
        };
        how.stop_wanted = options_.stop_wanted;
        how.on_evidence = [&](const Evidence& evidence) {
            replace_file(file_of(c, evidence_folder), evidence_text(evidence));
        };
        how.on_findings = [&](const Findings& findings) {
            replace_file(file_of(c, findings_folder), findings_text(findings));
        };
        try {
            const std::vector<Experiment> experiment{read_experiment(options_.challenge / c.folder)};
            options_.keep(file_of(c, ""), diagnose_experiment(device, scene_, experiment, how));
        } catch (const InputError& error) {
            replace_file(file_of(c, ""), nlohmann::json{{"problem", error.what()}}.dump(1) + "\n");
            options_.on_problem(fmt::format("{}: could not be diagnosed: {}", c.folder, error.what()));
        }
    }

    const Scene& scene_;
    const ChallengeRunOptions& options_;
    OpenChallenge challenge_;
    std::optional<FolderLock> lock_;
    std::optional<Experiment> first_;
    std::optional<LibraryPlan> plan_;
    std::optional<std::vector<std::vector<Trial>>> library_parts_;
    std::optional<Library> library_;
};

}  // namespace

void run_challenge(Device& device, const Scene& scene, const ChallengeRunOptions& options) {
    expect_plain_strokes(scene, "a challenge");
    ChallengeParts(scene, options, FolderLock::Use::alone).all(device);
}

std::unique_ptr<PartedWork> challenge_parts(const Scene& scene, const ChallengeRunOptions& options) {
    expect_plain_strokes(scene, "a challenge");
    return std::make_unique<ChallengeParts>(scene, options, FolderLock::Use::shared);
}

}  // namespace mcdem::challenge
