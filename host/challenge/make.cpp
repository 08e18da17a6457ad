#include "challenge/make.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <random>

#include "challenge/case_simulator.h"
#include "challenge/files.h"
#include "challenge/truth.h"
#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/input_file.h"
#include "core/look.h"
#include "core/make_folder.h"
#include "io/result_folder.h"
#include "scene/programme/legs.h"

namespace mcdem::inline challenge {
namespace {

namespace fs = std::filesystem;

constexpr double weaker = 0.8;  ///< factor of the amplitudes of a case that diverged, for the next try
constexpr int max_tries = 10;
constexpr double part_of_tries = 0.3;  ///< of the progress: only the loading, and not all cases

using Cases = std::vector<const ChallengeCase*>;

std::vector<std::string> effects_to_try(const ChallengeOptions& options, const Model& model) {
    if (!options.effects.empty()) return options.effects;
    std::vector<std::string> names;
    for (const std::string_view name : challenged_effects())
        if (find_effect(name)->hindrance(model).empty()) names.emplace_back(name);
    return names;
}

InputError of_another_challenge(const fs::path& file) {
    return InputError(
        fmt::format("{}: is of another challenge; choose another folder, or the same scene, seed and numbers",
                    file.string()));
}

/// Whether two challenges are equal except for the amplitudes of effects, which may have been reduced.
bool alike(Challenge a, Challenge b) {
    for (Challenge* challenge : {&a, &b})
        for (ChallengeCase& c : challenge->cases)
            for (Hidden& effect : c.effects) effect.amplitude = 0;
    return a == b;
}

/// experiment.toml is written last.
bool is_complete(const fs::path& folder) { return is_there(folder / "experiment.toml"); }

class Making {
public:
    Making(Device& device, const Scene& scene, const ChallengeOptions& options)
        : options_(options), simulator_(device, scene, options.measurement) {
        std::optional<Challenge> sealed;
        if (is_there(options.truth)) sealed = parse_truth(read_file(options.truth), options.truth.string());
        challenge_ =
            draw_challenge(options.size, effects_to_try(options, simulator_.stated()), simulator_.stated(),
                           simulator_.nuisances(), seal_of(scene.text), seed_of(sealed));
        is_sealed_ = sealed.has_value();
        if (sealed && !alike(*sealed, challenge_)) throw of_another_challenge(options.truth);
        if (sealed) challenge_ = *sealed;
    }

    std::string all() {
        Cases missing;
        for (const ChallengeCase& c : challenge_.cases)
            if (!is_sealed_ || !is_complete(options_.folder / c.folder)) missing.push_back(&c);
        if (!missing.empty()) simulator_.make_packings(challenge_.packing_seeds, options_.stop_wanted);
        if (!is_sealed_) weaken_diverging();
        const std::string seal = seal_all();
        const std::size_t before = challenge_.cases.size() - missing.size();
        in_batches(missing, [&](const Cases& batch, std::size_t first) {
            const auto recordings =
                simulator_.simulate(batch, CaseSimulator::Part::all, [&](double fraction) {
                    const double done =
                        static_cast<double>(before + first) + fraction * static_cast<double>(batch.size());
                    show(part_of_tries +
                         (1 - part_of_tries) * done / static_cast<double>(challenge_.cases.size()));
                });
            for (std::size_t k = 0; k < batch.size(); ++k) write(*batch[k], recordings[k]);
        });
        return seal;
    }

private:
    std::uint64_t seed_of(const std::optional<Challenge>& sealed) const {
        if (options_.seed) return *options_.seed;
        if (sealed) return sealed->seed;
        std::random_device machine;
        return static_cast<std::uint64_t>(machine()) << 32 | machine();
    }

    void show(double fraction) const {
        options_.on_progress(fraction);
        if (options_.stop_wanted()) throw Interrupted();
    }

    template <class Work>
    void in_batches(const Cases& cases, Work work) const {
        for (std::size_t first = 0; first < cases.size();) {
            const std::size_t last = std::min(cases.size(), first + simulator_.at_once());
            work(Cases(cases.begin() + static_cast<std::ptrdiff_t>(first),
                       cases.begin() + static_cast<std::ptrdiff_t>(last)),
                 first);
            first = last;
        }
    }

    /// Dense packings with interacting contacts have no static solution above some amplitude. Such cases
    /// are loaded again with weaker effects before the truth is sealed.
    void weaken_diverging() {
        Cases tried;
        for (const ChallengeCase& c : challenge_.cases)
            if (!c.effects.empty()) tried.push_back(&c);
        const double all = static_cast<double>(tried.size());
        for (int tries = 0; !tried.empty(); ++tries) {
            Cases failed;
            in_batches(tried, [&](const Cases& batch, std::size_t first) {
                const auto recordings =
                    simulator_.simulate(batch, CaseSimulator::Part::loading, [&](double fraction) {
                        const double part =
                            (static_cast<double>(first) + fraction * static_cast<double>(batch.size())) / all;
                        show(part_of_tries * (tries == 0 ? part : 1));
                    });
                for (std::size_t k = 0; k < batch.size(); ++k)
                    if (recordings[k].failure) failed.push_back(batch[k]);
            });
            if (!failed.empty() && tries == max_tries)
                throw RunError(fmt::format(
                    "{} simulated experiments diverge even with weak effects; compress less", failed.size()));
            for (const ChallengeCase* c : failed)
                for (Hidden& effect : challenge_.cases[c - challenge_.cases.data()].effects)
                    effect.amplitude *= weaker;
            tried = failed;
        }
    }

    /// Writes the truth first, then the public data.
    std::string seal_all() const {
        const std::string truth = is_sealed_ ? read_file(options_.truth) : truth_text(challenge_);
        const std::string seal = seal_of(truth);
        const fs::path open_file = options_.folder / "challenge.json";
        const std::string open = open_text(seal);
        if (is_there(open_file) && open_challenge_text(read_open_challenge(options_.folder)) != open)
            throw of_another_challenge(open_file);
        if (!is_there(open_file)) expect_no_cases();
        if (!is_sealed_ && !create_file(options_.truth, truth)) throw of_another_challenge(options_.truth);
        if (!is_there(open_file)) replace_file(open_file, open);
        return seal;
    }

    /// Folders that exist before the challenge belong to something else.
    void expect_no_cases() const {
        for (const ChallengeCase& c : challenge_.cases)
            if (is_there(options_.folder / c.folder))
                throw InputError(fmt::format(
                    "{}: is there without a challenge.json beside it, and is not replaced: give another "
                    "folder (--out)",
                    (options_.folder / c.folder).string()));
    }

    std::string open_text(const std::string& seal) const {
        OpenChallenge open{challenge_.scene_sha256, seal, {}};
        for (const ChallengeCase& c : challenge_.cases) {
            open.cases.push_back({c.folder, std::nullopt});
            if (c.struck.empty()) continue;
            auto& candidates = open.cases.back().candidates.emplace();
            for (const Effect& effect : effects())
                if (std::ranges::find(c.struck, effect.name) == c.struck.end())
                    candidates.emplace_back(effect.name);
        }
        return open_challenge_text(open);
    }

    void write(const ChallengeCase& c, const Recording& recording) const {
        if (recording.failure)
            throw RunError(
                fmt::format("{}: its simulation failed at {}", c.folder, recording.failure->text()));
        remove_temporaries(options_.folder / c.folder);
        write_experiment(options_.folder / c.folder, simulator_.experiment(c, recording), Packed::gzip);
    }

    const ChallengeOptions& options_;
    CaseSimulator simulator_;
    Challenge challenge_;
    bool is_sealed_ = false;
};

}  // namespace

std::string make_challenge(Device& device, const Scene& scene, const ChallengeOptions& options) {
    expect_plain_strokes(scene, "a challenge");
    if (fs::weakly_canonical(options.truth) == fs::weakly_canonical(options.folder / "challenge.json"))
        throw InputError(options.truth.string() +
                         ": is what may be known of the challenge: give another file for the truth");
    const FolderLock lock = open_output_folder(options.folder);
    make_folder_of(options.truth);
    remove_temporaries_of(options.truth);
    return Making(device, scene, options).all();
}

}  // namespace mcdem::challenge
