#include "report/diagnosis/diagnosis_where.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "report/diagnosis/diagnosis_values.h"
#include "report/diagnosis/diagnosis_words.h"

namespace mcdem::inline report {
namespace {

constexpr std::size_t max_places = 2;

/// The strongest of the framed cells in the figure, and their number.
struct Framed {
    const WhereCell* strongest = nullptr;
    int count = 0;
};
Framed framed_cells(const Diagnosis& diagnosis, bool refitted) {
    const auto size = [&](const WhereCell& cell) {
        return std::fabs(refitted ? cell.z_score_refitted : cell.z_score);
    };
    Framed framed;
    for (const auto& cell : diagnosis.cells) {
        if (!std::isfinite(size(cell)) || !stands_out(diagnosis, cell, refitted)) continue;
        ++framed.count;
        if (!framed.strongest || size(cell) > size(*framed.strongest)) framed.strongest = &cell;
    }
    return framed;
}

/// Without entries: single cells beyond the threshold, so that the text agrees with the figure.
std::string framed_line(const Diagnosis& diagnosis) {
    const Framed refitted = framed_cells(diagnosis, true), stated = framed_cells(diagnosis, false);
    if (refitted.count + stated.count == 0) return "no single value stands out from the noise.";
    const bool after = refitted.count > 0;
    const Framed& shown = after ? refitted : stated;
    auto text =
        fmt::format("{} of {} values {} beyond {:.1f} sigma {} (largest: {}, {:.1f} sigma)", shown.count,
                    diagnosis.cells.size(), shown.count == 1 ? "is" : "are", diagnosis.where_threshold,
                    after ? "after recalibration" : "with the parameters as stated",
                    words_of(shown.strongest->observable),
                    after ? shown.strongest->z_score_refitted : shown.strongest->z_score);
    if (!after)
        text += ", and none after recalibration";
    else if (!diagnosis.detected)
        text += "; with this many values, chance alone can give that";
    return text + ".";
}

}  // namespace

std::string where_line(const Diagnosis& diagnosis) {
    if (diagnosis.where.empty()) return framed_line(diagnosis);
    auto entries = diagnosis.where;
    std::ranges::stable_sort(entries, [](const WhereEntry& a, const WhereEntry& b) {
        return std::fabs(a.z_score) > std::fabs(b.z_score);
    });
    std::vector<std::string> parts, observables;
    for (const auto& entry : entries) {
        if (std::ranges::find(observables, entry.observable) != observables.end()) continue;
        observables.push_back(entry.observable);
        if (parts.size() < max_places) parts.push_back(where_words(entry));
    }
    auto text = fmt::format("{}", fmt::join(parts, "; "));
    if (observables.size() > parts.size())
        text += fmt::format("; and {} more observable{}", observables.size() - parts.size(),
                            observables.size() - parts.size() == 1 ? "" : "s");
    return text + ".";
}

}  // namespace mcdem::report
