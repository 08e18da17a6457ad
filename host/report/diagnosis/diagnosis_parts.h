// Data of the figures of a diagnosis.
#pragma once
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "diagnose/decide/diagnosis.h"

namespace mcdem::inline report {

/// Common colours. Blue and orange are distinguishable for colour-blind readers.
namespace diagnosis_colour {
inline constexpr const char* named = "#D55E00";
inline constexpr const char* other = "#6F9BBF";
inline constexpr const char* before = "#2B87C8";
inline constexpr const char* after = "#D55E00";
inline constexpr const char* faint = "#999999";
}  // namespace diagnosis_colour

/// The figure "where": one row per observable, one column per displacement.
struct HeatMap {
    struct Column {
        std::string phase;
        double displacement;  ///< [m]
        double x = 0;         ///< of its centre; columns have width 1, phases are separated
    };
    std::vector<std::string> observables;  ///< from top to bottom
    std::vector<Column> columns;           ///< in the order of the measurement: loading, then unloading
    double width = 0;

    int row(const WhereCell& cell) const;
    const Column& column(const WhereCell& cell) const;
};
HeatMap heat_map_of(const std::vector<WhereCell>& cells);

/// Whether any cell has a value.
bool has_cells(const Diagnosis& diagnosis);

/// Whether the cell is significant. If the threshold is unknown, the cells of the entries are significant
/// before recalibration, and none after.
bool stands_out(const Diagnosis& diagnosis, const WhereCell& cell, bool refitted);

/// End of the colour scale in sigmas, so that outliers do not hide other cells and noise does not look like a
/// gap.
double colour_range(const std::vector<WhereCell>& cells);

/// Candidates that the verdict names: the leading effect and its group; none if no effect explains the gap.
std::set<std::string> named_effects(const Diagnosis& diagnosis);

/// Candidates that these data cannot distinguish share a letter: "A", "AB"; empty for a single one. By index
/// in the ranking.
std::vector<std::string> group_letters(const std::vector<Cause>& ranking);

/// A fitted amplitude over the detection limit, so that all effects have the same unit.
struct ShownAmplitude {
    std::size_t place;  ///< index in the ranking
    double over;
    double half;  ///< half width of its 90 % interval
};
std::vector<ShownAmplitude> shown_amplitudes(const Diagnosis& diagnosis);

/// Displacement [m], experiment, before and after [N], where all are known.
std::vector<std::array<double, 4>> known_forces(const GapReduction& gap_reduction);

/// Legend of the simulated force after the change.
std::string words_after(const Diagnosis& diagnosis);

/// A remaining part of the gap.
struct GapBar {
    std::string words, colour;
    double value;  ///< over the gap before
    std::optional<std::array<double, 2>> interval;
};
std::vector<GapBar> gap_bars(const GapReduction& gap_reduction);

}  // namespace mcdem::report
