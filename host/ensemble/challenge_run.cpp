#include "ensemble/challenge_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/make_folder.h"
#include "core/output_file.h"
#include "core/sha256.h"
#include "diagnose/challenge_evidence.h"
#include "diagnose/challenge_files.h"
#include "ensemble/agreement.h"
#include "ensemble/library_origin.h"
#include "ensemble/make_packings.h"
#include "io/folder_lock.h"
#include "io/result_folder.h"
#include "scene/random.h"

namespace mcdem {
namespace {

namespace fs = std::filesystem;

/// In simulations, for the progress.
double work_for(const ChallengeLibrary& library, std::size_t probes) {
    return library.packings * (library.replicates + 2.0 * library.pairs * static_cast<double>(probes));
}

constexpr std::chrono::milliseconds pause{500};  ///< of a program that waits for the others

const char* const evidence_folder = "evidence";
const char* const findings_folder = "findings";
fs::path claims_folder(const fs::path& out) { return out / "claims"; }
fs::path case_file(const fs::path& folder, const OpenCase& c) { return folder / (c.folder + ".json"); }

std::string text_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::size_t grains_of(const Experiment& experiment) { return experiment.recording.diameter.size(); }

class Running {
public:
    Running(Device& device, const Scene& scene, const ChallengeRunOptions& options)
        : device_(device),
          scene_(scene),
          options_(options),
          challenge_(read_open_challenge(options.challenge)) {
        if (Sha256().add(scene.text).hex() != challenge_.scene)
            throw InputError(fmt::format("{}: is not the scene that {} was made with", scene.name,
                                         (options.challenge / "challenge.json").string()));
        for (const OpenCase& c : challenge_.cases)
            if (!fs::exists(options.challenge / c.folder / "experiment.toml"))
                throw InputError(fmt::format("{}: {} is not made yet: go on with `mcdem challenge make`",
                                             options.challenge.string(), c.folder));
        make_folder_of(options.library.file);  // now, not after the library is made
    }

    void all() {
        const auto left = missing();
        if (left.empty()) return;
        left_ = left.size();
        make_library(challenge_.cases.front());
        for (const OpenCase* c : left) {
            diagnose(*c, nullptr);
            --left_;
        }
    }

    /// With other programs: each takes a case that no other has.
    void share() {
        left_ = missing().size();
        if (left_ == 0) return;
        Claims claims(claims_folder(options_.out), {device_.info().index, device_.info().name});
        claims_ = &claims;
        agree(claims_folder(options_.out) / "agreement.json", common(), {});
        make_library(challenge_.cases.front());
        for (auto left = missing(); !left.empty(); left = missing()) {
            left_ = left.size();
            std::vector<std::string> names;
            for (const OpenCase* c : left) names.push_back(c->folder);
            show(0);
            if (options_.stop_wanted()) throw Interrupted();
            const auto claim = claims.take_one_of(names);
            if (!claim)
                std::this_thread::sleep_for(pause);
            else if (const OpenCase& c = **std::ranges::find(left, claim->task(), &OpenCase::folder);
                     !is_done(c))
                diagnose(c, claim.get());
        }
        std::error_code used_by_another;  // .. which removes it in its turn
        fs::remove_all(claims_folder(options_.out), used_by_another);
    }

private:
    fs::path file_of(const OpenCase& c, const std::string& folder) const {
        return case_file(options_.out / folder, c);
    }
    bool is_done(const OpenCase& c) const { return fs::exists(file_of(c, "")); }
    std::vector<const OpenCase*> missing() const {
        std::vector<const OpenCase*> cases;
        for (const OpenCase& c : challenge_.cases)
            if (!is_done(c)) cases.push_back(&c);
        return cases;
    }
    Common common() const {
        Common all = common_of(device_, scene_, options_.program);
        all["challenge"] = Sha256().add(text_of(options_.challenge / "challenge.json")).hex();
        const ChallengeLibrary& library = options_.library;
        all["options"] = fmt::format(
            "replicates {}, confirmations {}, library {} packings, {} replicates, {} pairs, of {}, seed {}",
            options_.replicates, options_.confirmations, library.packings, library.replicates, library.pairs,
            fmt::join(library.candidates, ","), options_.seed);
        return all;
    }
    fs::path library_file() const { return options_.out / "library.json"; }
    double work_a_case() const { return options_.replicates + 2.0 * options_.confirmations; }

    /// Other packings of the same kind; the seeds of the cases' are not known here, and are not met by
    /// chance.
    std::vector<Packing> other_packings(const Replica& replica) const {
        constexpr std::uint64_t apart = 0x6c696272617279;
        Scene all = scene_;
        all.replicas.clear();
        for (int p = 0; p < options_.library.packings; ++p) {
            all.replicas.push_back(replica);
            all.replicas.back().packing.seed =
                scattered(scattered(options_.seed + apart) + static_cast<std::uint64_t>(p)) >> 16;
        }
        auto packings = make_packings(all, options_.stop_wanted);
        if (packings.size() < all.replicas.size()) throw Interrupted();
        return packings;
    }

    /// The grid of an experiment whose plate went as the scene's does: a case's own zero of strain is not the
    /// scene's.
    Grid grid_of_scene(const Experiment& experiment) const {
        const Plate& plate = scene_.replicas.front().plate;
        Grid grid = grid_of(experiment.recording);
        const double factor = (plate.start - plate.end) / grid.stroke;
        for (double& displacement : grid.displacement) displacement *= factor;
        grid.width *= factor;
        grid.stroke *= factor;
        return grid;
    }

    Question question_of(const Experiment& experiment) const {
        const Model model = model_of(scene_, experiment);
        return {scene_, grid_of_scene(experiment), reference_material(model), model.replica.protocol.discard,
                options_.program};
    }

    Library new_library(const Experiment& experiment) {
        Model model = model_of(scene_, experiment);
        model.replica.plate = scene_.replicas.front().plate;
        const Question question = question_of(experiment);
        LibraryPlan plan;
        plan.packings = other_packings(model.replica);
        plan.replicates = options_.library.replicates;
        plan.pairs = options_.library.pairs;
        plan.jitter = experiment.measurement.position_error;
        plan.diameter_jitter = experiment.measurement.diameter_error;
        plan.seed = options_.seed;
        plan.candidates = choose_candidates(model, options_.library.candidates).chosen;
        plan.nuisances = nuisances(model, experiment);
        work_of_library_ = work_for(options_.library, plan.candidates.size() + plan.nuisances.size());
        TrialOptions trials;
        trials.on_progress = [&](double fraction) { show(fraction * work_of_library_); };
        trials.stop_wanted = options_.stop_wanted;
        trials.claims = claims_;
        return build_library(device_, question, model, plan, ObservationStore(options_.out / "simulations"),
                             trials);
    }

    /// Reads the library, or makes it as the first case is measured; a copy goes to the results. Throws
    /// InputError where it was made from something else, or the results are of another one.
    void make_library(const OpenCase& first) {
        const fs::path& file = options_.library.file;
        const Experiment experiment = read_experiment(options_.challenge / first.folder);
        if (!fs::exists(file)) {
            create_file(file, library_text(new_library(experiment)));  // or another program was quicker
        }
        library_ = read_library(file);
        expect_origin(
            library_,
            library_origin(question_of(experiment), model_of(scene_, experiment), grains_of(experiment)),
            file);
        const std::string text = library_text(library_);
        if (!create_file(library_file(), text) && text_of(library_file()) != text)
            throw InputError(fmt::format(
                "{}: is another library than {}, and cases there were diagnosed with it: give that "
                "library, or another folder (--out)",
                library_file().string(), file.string()));
    }

    std::vector<std::string> candidates_of(const OpenCase& c) const {
        std::vector<std::string> names;
        for (const Signature& effect : library_.effects)
            if (!c.candidates || std::ranges::find(*c.candidates, effect.name) != c.candidates->end())
                names.push_back(effect.name);
        return names;
    }

    void diagnose(const OpenCase& c, Claim* claim) {
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
            const double part = stage == "baseline" ? 0.5 * fraction : 0.5 + 0.5 * fraction;
            show(work_a_case() * part);
            if (claim) claim->show(part);
        };
        how.stop_wanted = options_.stop_wanted;
        how.on_evidence = [&](const Evidence& evidence) {
            replace_file(file_of(c, evidence_folder), evidence_text(evidence));
        };
        how.on_findings = [&](const Findings& findings) {
            replace_file(file_of(c, findings_folder), findings_text(findings));
        };
        try {
            const Experiment experiment = read_experiment(options_.challenge / c.folder);
            options_.keep(file_of(c, ""), diagnose_experiment(device_, scene_, experiment, how));
        } catch (const InputError& error) {
            replace_file(file_of(c, ""), nlohmann::json{{"problem", error.what()}}.dump(1) + "\n");
            options_.on_problem(fmt::format("{}: could not be diagnosed: {}", c.folder, error.what()));
        }
    }

    /// `work_now`: of the library while it is made, else of this case.
    void show(double work_now) const {
        const auto cases = static_cast<double>(challenge_.cases.size());
        const double done = (library_.effects.empty() ? 0 : work_of_library_) +
                            work_a_case() * (cases - static_cast<double>(left_));
        options_.on_progress((done + work_now) / (work_of_library_ + work_a_case() * cases));
    }

    Device& device_;
    const Scene& scene_;
    const ChallengeRunOptions& options_;
    OpenChallenge challenge_;
    Library library_;
    double work_of_library_ = 0;
    std::size_t left_ = 0;      ///< cases
    Claims* claims_ = nullptr;  ///< where the work is shared
};

/// What lies in the folder is looked at once those cannot come any more whom the lock keeps away.
FolderLock lock_folder(const fs::path& out, FolderLock::Use use) {
    expect_no_experiment(out);
    FolderLock lock(out, use);
    if (const fs::path file = file_of_a_run(out); !file.empty())
        throw InputError(
            fmt::format("{}: holds a run ({}): give another folder for the answers to a challenge",
                        out.string(), file.filename().string()));
    return lock;
}

}  // namespace

void expect_sharable_challenge(const fs::path& out) {
    expect_no_file(out);
    if (fs::exists(out)) lock_folder(out, FolderLock::Use::shared);
}

void expect_no_challenge(const fs::path& folder) {
    if (fs::exists(folder / evidence_folder))
        throw InputError(folder.string() +
                         ": holds the answers to a challenge: give another folder for a run");
}

void run_challenge(Device& device, const Scene& scene, const ChallengeRunOptions& options) {
    Running running(device, scene, options);
    expect_no_experiment(options.out);
    make_result_folder(options.out);
    const FolderLock lock =
        lock_folder(options.out, options.share ? FolderLock::Use::shared : FolderLock::Use::alone);
    for (const char* folder : {evidence_folder, findings_folder}) make_folder(options.out / folder);
    if (!options.share) return running.all();
    try {
        running.share();
    } catch (const RunError&) {
        if (cases_done(options) < 1) throw;  // else others have ended all, and taken the claims away
    }
}

double cases_done(const ChallengeRunOptions& options) {
    const OpenChallenge challenge = read_open_challenge(options.challenge);
    std::map<std::string, double> under_way;
    if (fs::exists(claims_folder(options.out))) under_way = Claims(claims_folder(options.out)).under_way();
    double done = 0;
    for (const OpenCase& c : challenge.cases) {
        const auto held = under_way.find(c.folder);
        done += fs::exists(case_file(options.out, c)) ? 1 : held == under_way.end() ? 0 : 0.99 * held->second;
    }
    return challenge.cases.empty() ? 1 : done / static_cast<double>(challenge.cases.size());
}

}  // namespace mcdem
