#include "ensemble/diagnosis/change_of_the_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <span>

#include "scene/read/keys.h"

namespace mcdem::inline ensemble {
namespace {

/// "contact.gamma = 1.16" for every key that differs in the second replica.
std::vector<std::string> differing_keys(const Replica& before, const Replica& after) {
    Settings a, b;
    a.replica = before;
    b.replica = after;
    std::vector<std::string> list;
    for (const Key& key : keys()) {
        if (key.scope != Scope::replica || value_text(key, a) == value_text(key, b)) continue;
        const std::string text = value_text(key, b);
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        list.push_back(fmt::format("{} = {}", key.name, *end ? text : fmt::format("{:.3g}", value)));
    }
    return list;
}

void apply(Model& model, const Cause& cause, const std::vector<Nuisance>& nuisances) {
    if (const Effect* effect = find_effect(cause.effect)) return effect->apply(model, cause.amplitude);
    const auto nuisance = std::ranges::find(nuisances, cause.effect, &Nuisance::name);
    if (nuisance != nuisances.end()) nuisance->apply(model, cause.amplitude);
}

/// The causes that are changed together; of a group only the leading one.
std::span<const Cause> changed_together(const std::vector<Cause>& causes) {
    return std::span(causes).first(causes.front().group.size() == 1 ? causes.size() : 1);
}

NextStep to_refine(const Refinement& r) {
    return {fmt::format("set {} = {:.3g}{} in the scene (now {:.3g}), or let the diagnosis refine it with "
                        "--refine {:.0f}, and diagnose again",
                        r.key, r.to, r.unit.empty() ? "" : " " + r.unit, r.from, r.from / r.to),
            {}};
}

/// Errors of measurement have no key in the scene.
NextStep to_check_measurement(std::span<const Cause> causes) {
    std::vector<std::string> words;
    for (const Cause& cause : causes) {
        const Effect* effect = find_effect(cause.effect);
        words.push_back(effect ? std::string(effect->words)
                               : "the zero of the displacement ([plate] start in experiment.toml)");
    }
    return {fmt::format("check the measurement for {}: the scene describes no errors of measurement",
                        fmt::join(words, " and ")),
            {}};
}

}  // namespace

std::optional<NextStep> change_of_the_scene(const Diagnosis& diagnosis, const Model& model,
                                            const std::vector<Nuisance>& nuisances) {
    if (!diagnosis.refinements.empty() && !diagnosis.refinements.back().done)
        return to_refine(diagnosis.refinements.back());
    if (diagnosis.verdict == Verdict::unknown_effect || diagnosis.causes.empty()) return std::nullopt;
    const auto causes = changed_together(diagnosis.causes);
    Model changed = model;
    for (const Cause& cause : causes) apply(changed, cause, nuisances);
    const std::vector<std::string> settings = differing_keys(model.replica, changed.replica);
    if (settings.empty()) return to_check_measurement(causes);
    return NextStep{
        fmt::format("set {} in the scene, and test with another packing whether the gap disappears",
                    fmt::join(settings, ", ")),
        {}};
}

}  // namespace mcdem::ensemble
