#pragma once
#include <string>
#include <vector>

#include "diagnose/decide/diagnosis.h"

namespace mcdem::inline report {

std::string verdict_headline(const Diagnosis& diagnosis);
std::string verdict_sentence(const Diagnosis& diagnosis);

struct VerdictLine {
    std::string about;  ///< First, Gap, Where, Which, How far, Limits, Next
    std::string says;
};

/// Parameters to check before anything else, if there are any; existence and location of the gap, consistent
/// effects, gap reduction, limits, and next steps.
std::vector<VerdictLine> verdict_lines(const Diagnosis& diagnosis);

/// These lines, aligned, each with a line feed.
std::string diagnosis_text(const Diagnosis& diagnosis);

}  // namespace mcdem::report
