// The three pictures of a diagnosis: where the gap is, which effects are consistent with it, how far it
// shrinks.
#pragma once
#include <optional>

#include "diagnose/diagnosis.h"
#include "report/plot_script.h"

namespace mcdem {

/// Heat map of observables and displacements, before and after recalibration, cells that stand out framed.
/// Nothing without cells.
std::optional<Figure> where_figure(const Diagnosis& diagnosis);

/// Candidates by score, those of one letter not to be told apart, with their amplitudes over what these data
/// can detect. Nothing without a ranking.
std::optional<Figure> which_figure(const Diagnosis& diagnosis);

/// Top force and gap, before and after the effect is added. Nothing without a
/// shrink, or where the data held out show no gap.
std::optional<Figure> how_far_figure(const Diagnosis& diagnosis);

/// Candidates that these data cannot tell apart share a letter: "A", "AB", empty where one stands alone. By
/// place in the ranking.
std::vector<std::string> group_letters(const std::vector<Cause>& ranking);

/// What the pictures have in common. Blue and orange are told apart by the colour-blind.
namespace diagnosis_colour {
inline constexpr const char* named = "#D55E00";
inline constexpr const char* other = "#6F9BBF";
inline constexpr const char* before = "#2B87C8";
inline constexpr const char* after = "#D55E00";
inline constexpr const char* faint = "#999999";
}  // namespace diagnosis_colour

}  // namespace mcdem
