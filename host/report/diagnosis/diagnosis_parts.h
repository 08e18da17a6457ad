// What the pictures of a diagnosis show, made ready for drawing.
#pragma once
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "diagnose/decide/diagnosis.h"

namespace mcdem::inline report {

/// What the figures have in common. Blue and orange are told apart by the colour-blind.
namespace diagnosis_colour {
inline constexpr const char* named = "#D55E00";
inline constexpr const char* other = "#6F9BBF";
inline constexpr const char* before = "#2B87C8";
inline constexpr const char* after = "#D55E00";
inline constexpr const char* faint = "#999999";
}  // namespace diagnosis_colour

/// The figure "where": a row an observable, a column a displacement.
struct HeatMap {
    struct Column {
        std::string phase;
        double displacement;  ///< [m]
        double x = 0;         ///< of its middle; columns are 1 wide, phases lie apart
    };
    std::vector<std::string> observables;  ///< from top to bottom
    std::vector<Column> columns;           ///< in the order of the measurement: loading, then back
    double width = 0;

    int row(const WhereCell& cell) const;
    const Column& column(const WhereCell& cell) const;
};
HeatMap heat_map_of(const std::vector<WhereCell>& cells);

/// Whether any cell has a number.
bool has_cells(const Diagnosis& diagnosis);

/// Where the threshold is not known, the cells of the entries stand out before recalibration, and none after.
bool stands_out(const Diagnosis& diagnosis, const WhereCell& cell, bool refitted);

/// The colours end at this many sigmas: outliers must not fade all others, nor noise look like a gap.
double colour_range(const std::vector<WhereCell>& cells);

/// Candidates that the verdict names: the leader and its group, none where no effect explains the gap.
std::set<std::string> named_effects(const Diagnosis& diagnosis);

/// Candidates that these data cannot tell apart share a letter: "A", "AB", empty where one stands alone. By
/// place in the ranking.
std::vector<std::string> group_letters(const std::vector<Cause>& ranking);

/// A fitted amplitude over the smallest detectable one: that makes all units one.
struct ShownAmplitude {
    std::size_t place;  ///< in the ranking
    double over;
    double half;  ///< of its 90 % interval
};
std::vector<ShownAmplitude> shown_amplitudes(const Diagnosis& diagnosis);

/// Displacement [m], experiment, before and after [N]: those that are known in full.
std::vector<std::array<double, 4>> known_forces(const GapReduction& gap_reduction);

/// What the simulated force after the change is called.
std::string words_after(const Diagnosis& diagnosis);

/// A part of the gap that is left.
struct GapBar {
    std::string words, colour;
    double value;  ///< over the gap before
    std::optional<std::array<double, 2>> interval;
};
std::vector<GapBar> gap_bars(const GapReduction& gap_reduction);

}  // namespace mcdem::report
