// The score of a challenge as tables, JSON and figures.
#pragma once
#include <nlohmann/json.hpp>
#include <vector>

#include "challenge/score.h"
#include "report/page/text_table.h"

namespace mcdem::inline cli {

/// Figures of merit of the whole method with 95 % intervals and what is asked; both halves.
TextTable table_of_merits(const ChallengeScore& score);
/// Every arm on the scored half.
TextTable table_of_arms(const ChallengeScore& score);
/// Detected and named, by effect.
TextTable table_of_effects(const ChallengeScore& score);
/// Named although unknown, by what it was.
TextTable table_of_unknown(const ChallengeScore& score);
/// Limits that the first half led to, and the defaults.
TextTable table_of_limits(const ChallengeScore& score);

/// All of it as Markdown.
std::string score_markdown(const ChallengeScore& score);
/// All of it for programs.
std::string score_json(const ChallengeScore& score);

/// What its figures show (report/run/figure_values.h), those that there are.
nlohmann::ordered_json score_figure_values(const ChallengeScore& score);

}  // namespace mcdem::cli
