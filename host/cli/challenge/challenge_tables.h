// The score of a challenge as tables and JSON.
#pragma once
#include "challenge/score.h"
#include "report/page/text_table.h"

namespace mcdem::inline cli {

/// Figures of merit of the whole method with 95 % intervals and targets, for both halves.
TextTable table_of_merits(const ChallengeScore& score);
/// All methods on the scored half.
TextTable table_of_arms(const ChallengeScore& score);

/// The complete score as Markdown.
std::string score_markdown(const ChallengeScore& score);
/// The complete score as JSON.
std::string score_json(const ChallengeScore& score);

}  // namespace mcdem::cli
