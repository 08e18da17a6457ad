#include "scene/programme/scan_quantity.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <set>

#include "scene/programme/cell_path.h"

namespace mcdem::inline scene {
namespace {

using Values = std::array<double, 6>;

/// Changes that differ by less, relative, count as equal.
constexpr double rounding = 1e-9;
const std::bitset<6> normals(0b000111), shears(0b111000);

/// The values that a move changes; values that are not known yet are NaN.
std::bitset<6> changed(const Values& before, const Values& targets) {
    std::bitset<6> changed;
    for (std::size_t k = 0; k < targets.size(); ++k)
        changed[k] = !std::isnan(targets[k]) && targets[k] != before[k];
    return changed;
}

bool have_one_target(const std::bitset<6>& some, const Values& targets) {
    double target = not_given;
    for (std::size_t k = 0; k < targets.size(); ++k) {
        if (!some[k]) continue;
        if (!std::isnan(target) && targets[k] != target) return false;
        target = targets[k];
    }
    return (some & normals).none() || (some & shears).none();
}

/// The first of those that change most; none if their start is not known.
std::bitset<6> leading(const std::bitset<6>& some, const Values& before, const Values& targets) {
    double most = 0;
    std::bitset<6> leading;
    for (std::size_t k = 0; k < targets.size(); ++k) {
        const double change = std::abs(targets[k] - before[k]);
        if (!some[k]) continue;
        if (std::isnan(change)) return {};
        if (change > most * (1 + rounding)) leading.reset().set(k), most = change;
    }
    return leading;
}

ScanQuantity quantity_of(bool of_stress, const Values& before, const Values& targets) {
    const std::bitset<6> some = changed(before, targets);
    ScanQuantity quantity{of_stress, some};
    if (!have_one_target(some, targets)) quantity.counts = leading(some, before, targets);
    quantity.begin = quantity.mean(before);
    quantity.target = quantity.mean(targets);
    return quantity;
}

Values named_strains(const Stage& stage) {
    Values nothing;
    nothing.fill(not_given);
    return strain_after(stage, nothing);
}

std::optional<std::string> problem_of(const Stage& stage, const ScanQuantity& quantity) {
    if (quantity.counts.none())
        return "must be left out: the move changes several strains or stresses, and only the run shows which "
               "one "
               "changes most, or it changes none (take scans instead)";
    double before = quantity.begin;
    const bool up = quantity.target > (std::isnan(before) ? stage.scan_at.front() : before);
    for (const double at : stage.scan_at) {
        const bool follows = std::isnan(before) || (up ? at > before : at < before);
        const bool within = at == quantity.target || (up ? at < quantity.target : at > quantity.target);
        if (!follows || !within)
            return fmt::format("must be values of {} on the way {}to {}, one after the other, got {}{}",
                               quantity_name(stage, quantity),
                               std::isnan(quantity.begin) ? "" : fmt::format("from {} ", quantity.begin),
                               quantity.target, at,
                               std::isnan(before) ? "" : fmt::format(" after {}", before));
        before = at;
    }
    return std::nullopt;
}

}  // namespace

double ScanQuantity::mean(const Values& values) const {
    double first = not_given, sum = 0;  // of the differences from the first, so that equal values are exact
    for (std::size_t k = 0; k < values.size(); ++k) {
        if (!counts[k]) continue;
        if (std::isnan(first)) first = values[k];
        sum += values[k] - first;
    }
    return first + sum / static_cast<double>(counts.count());
}

std::vector<ScanQuantity> scan_quantities(const std::vector<Stage>& stages, const std::vector<Leg>& legs) {
    std::vector<ScanQuantity> all;
    Values strain{}, stress = no_stress;
    for (const Leg& leg : legs) {
        const Stage& stage = stages[leg.stage];
        all.emplace_back();
        if (stage.kind == StageKind::hold) {
            if (stage.keep == Controlled::position) stress = no_stress;
            continue;
        }
        const Values strains = named_strains(stage), stresses = set_stress(stage);
        const bool strained = changed(strain, strains).any();
        all.back() = strained ? quantity_of(false, strain, strains) : quantity_of(true, stress, stresses);
        strain = strain_after(stage, strain);
        for (std::size_t k = 0; k < strain.size(); ++k)
            if (!std::isnan(stresses[k])) strain[k] = not_given;
        stress = stresses;
    }
    return all;
}

std::string quantity_name(const Stage& stage, const ScanQuantity& quantity) {
    const bool normal = (quantity.counts & shears).none();
    if (normal && !std::isnan(quantity.of_stress ? stage.pressure : stage.strain))
        return quantity.of_stress ? "pressure" : "strain";
    std::vector<std::string> names;
    for (std::size_t k = 0; k < axis_names.size(); ++k)
        if (quantity.counts[k])
            names.push_back(fmt::format("{}_{}",
                                        quantity.of_stress ? "stress"
                                        : k < 3            ? "strain"
                                                           : "shear",
                                        axis_names[k]));
    return (names.size() > 1 ? "the mean of " : "") + fmt::format("{}", fmt::join(names, ", "));
}

std::vector<std::pair<int, std::string>> scan_at_problems(const std::vector<Stage>& stages,
                                                          const Plate& plate) {
    std::vector<std::pair<int, std::string>> problems;
    std::set<int> told;
    const std::vector<Leg> legs = legs_of(stages, plate);
    const std::vector<ScanQuantity> quantities = scan_quantities(stages, legs);
    for (std::size_t l = 0; l < legs.size(); ++l) {
        const Stage& stage = stages[legs[l].stage];
        if (stage.kind != StageKind::move || stage.scan_at.empty() || told.contains(legs[l].stage)) continue;
        const auto problem = problem_of(stage, quantities[l]);
        if (problem && told.insert(legs[l].stage).second) problems.emplace_back(legs[l].stage, *problem);
    }
    return problems;
}

}  // namespace mcdem::scene
