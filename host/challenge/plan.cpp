#include "challenge/plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "challenge/outside.h"
#include "core/errors.h"
#include "scene/random.h"

namespace mcdem::inline challenge {
namespace {

constexpr std::string_view tried[] = {"cross_contact",   "friction",   "adhesion",         "viscoelasticity",
                                      "stiffening",      "plasticity", "buoyancy",         "diameter_error",
                                      "modulus_scatter", "plate_tilt", "plate_compliance", "force_bias",
                                      "gauge_drift"};

/// Pairs of effects that differ only in direction.
constexpr std::array<std::string_view, 2> twins[] = {{"plate_tilt", "plate_tilt_y"}};

constexpr int every_struck =
    4;  ///< of the unknown cases, one in this number has its effect removed from the library
constexpr double nearest = 4, farthest = 8;  ///< shifts of nuisances outside their prior, in sigmas

/// Lower end of the amplitudes: a tenth of the smaller, the smaller, or the larger of the library's two
/// amplitudes. The upper end is 1.5 times the larger one.
enum class Strength { any, clear, strong };

class Drawing {
public:
    Drawing(const Model& model, std::span<const Nuisance> nuisances, std::uint64_t seed)
        : model_(model), nuisances_(nuisances), random_(seed, Stream::challenge) {}

    double log_uniform(double low, double high) { return low * std::pow(high / low, random_.uniform()); }
    double sign() { return random_.uniform() < 0.5 ? -1 : 1; }

    Hidden effect(std::string_view name, Strength strength) {
        const Effect& effect = *find_effect(name);
        const auto [smaller, larger] = std::minmax({std::abs(effect.first), std::abs(effect.second)});
        const double from = strength == Strength::any     ? 0.1 * smaller
                            : strength == Strength::clear ? smaller
                                                          : larger;
        const double size = log_uniform(from, 1.5 * larger);
        const bool both_signs = -effect.low >= larger;
        const double amplitude =
            both_signs && sign() < 0 ? std::max(-size, effect.low) : std::min(size, effect.high);
        return {std::string(name), amplitude * effect.scale(model_)};
    }

    Hidden outside(const OutsideEffect& effect) {
        return {std::string(effect.name),
                log_uniform(effect.low, effect.high) * (effect.both_signs ? sign() : 1)};
    }

    std::vector<Hidden> from_priors() {
        std::vector<Hidden> shifts;
        for (const Nuisance& nuisance : nuisances_)
            shifts.push_back({nuisance.name, nuisance.sigma * random_.normal()});
        return shifts;
    }

    Hidden outside_prior(const std::string& name) {
        const auto nuisance = std::ranges::find(nuisances_, name, &Nuisance::name);
        return {name, sign() * random_.uniform(nearest, farthest) * nuisance->sigma};
    }

    Random& random() { return random_; }

private:
    const Model& model_;
    std::span<const Nuisance> nuisances_;
    Random random_;
};

/// The effect, and the same effect in another direction if there is one.
std::vector<std::string> with_twin(const std::string& name) {
    for (const auto& pair : twins)
        if (std::ranges::find(pair, name) != pair.end()) return {std::string(pair[0]), std::string(pair[1])};
    return {name};
}

/// Cases of all kinds, sorted by kind.
std::vector<ChallengeCase> draw_cases(const ChallengeSize& size, const std::vector<std::string>& effects,
                                      Drawing& draw) {
    std::vector<ChallengeCase> cases;
    const auto add = [&](CaseKind kind, std::vector<Hidden> hidden) -> ChallengeCase& {
        cases.push_back({"", kind, std::move(hidden), draw.from_priors(), {}, 0, 0});
        return cases.back();
    };
    for (int k = 0; k < size.none; ++k) add(CaseKind::none, {});
    for (const std::string& name : effects)
        for (int k = 0; k < size.per_effect; ++k) add(CaseKind::effect, {draw.effect(name, Strength::any)});
    for (int k = 0; k < size.pairs; ++k) {
        std::vector<std::string> both = effects;
        draw.random().shuffle(both);
        add(CaseKind::pair, {draw.effect(both[0], Strength::clear), draw.effect(both[1], Strength::clear)});
    }
    std::vector<std::string> struck = effects;
    draw.random().shuffle(struck);
    const auto others = outside_effects();
    for (int k = 0, strikes = 0; k < size.unknown; ++k)
        if (k % every_struck == 0) {
            const std::string& name = struck[static_cast<std::size_t>(strikes++) % struck.size()];
            add(CaseKind::unknown, {draw.effect(name, Strength::strong)}).struck = with_twin(name);
        } else {
            add(CaseKind::unknown,
                {draw.outside(others[static_cast<std::size_t>(k - strikes) % others.size()])});
        }
    const std::string far[] = {"modulus", "strain_offset"};
    for (int k = 0; k < size.outside_prior; ++k) {
        const Hidden shift = draw.outside_prior(far[k % 2]);
        auto& nuisances = add(CaseKind::outside_prior, {}).nuisances;
        *std::ranges::find(nuisances, shift.name, &Hidden::name) = shift;
    }
    return cases;
}

/// Distributes every kind evenly over both halves, and over the packings of each half.
void deal_packings(std::vector<ChallengeCase>& cases, int packings, Random& random) {
    for (int half = 0; half < 2; ++half) {
        std::vector<std::size_t> mine;
        for (auto k = static_cast<std::size_t>(half); k < cases.size(); k += 2) mine.push_back(k);
        random.shuffle(mine);
        for (std::size_t k = 0; k < mine.size(); ++k)
            cases[mine[k]].packing = 2 * (static_cast<int>(k) % (packings / 2)) + half;
    }
}

void check(const ChallengeSize& size, const std::vector<std::string>& effects, const Model& model) {
    std::vector<std::string> problems;
    for (const auto& [option, value] : {std::pair{"none", size.none},
                                        {"per-effect", size.per_effect},
                                        {"pairs", size.pairs},
                                        {"unknown", size.unknown},
                                        {"outside", size.outside_prior}})
        if (value < 0) problems.push_back(fmt::format("--{} must be 0 or more, got {}", option, value));
    if (size.packings < 2 || size.packings % 2)
        problems.push_back(fmt::format(
            "--packings must be an even number, one half for the limits and one for the score, got {}",
            size.packings));
    for (const std::string& name : effects) {
        const Effect* effect = find_effect(name);
        if (!effect) {
            std::vector<std::string_view> known;
            for (const Effect& e : mcdem::effects()) known.push_back(e.name);
            problems.push_back(
                fmt::format("--effects: {} is not an effect; there are {}", name, fmt::join(known, ", ")));
        } else if (const auto hindrance = effect->hindrance(model); !hindrance.empty()) {
            problems.push_back(fmt::format("--effects: {} cannot be tried: {}", name, hindrance));
        }
    }
    if (effects.size() < 2) problems.push_back("--effects: two at least are needed, for pairs");
    if (!problems.empty()) throw InputError(problems);
}

/// Small enough for every file format, and independent for consecutive seeds.
std::uint64_t derived_seed(std::uint64_t seed, std::uint64_t number) {
    return scattered(scattered(seed) + number) >> 16;
}

}  // namespace

std::span<const std::string_view> challenged_effects() { return tried; }

Challenge draw_challenge(const ChallengeSize& size, const std::vector<std::string>& effects,
                         const Model& model, std::span<const Nuisance> nuisances, const std::string& scene,
                         std::uint64_t seed) {
    check(size, effects, model);
    Challenge challenge{seed, scene, {}, {}};
    Drawing draw(model, nuisances, seed);
    challenge.cases = draw_cases(size, effects, draw);
    deal_packings(challenge.cases, size.packings, draw.random());
    draw.random().shuffle(challenge.cases);
    std::uint64_t number = 0;
    for (int p = 0; p < size.packings; ++p) challenge.packing_seeds.push_back(derived_seed(seed, ++number));
    for (std::size_t k = 0; k < challenge.cases.size(); ++k) {
        challenge.cases[k].seed = derived_seed(seed, ++number);
        challenge.cases[k].folder = fmt::format("case_{:04}", k + 1);
    }
    return challenge;
}

}  // namespace mcdem::challenge
