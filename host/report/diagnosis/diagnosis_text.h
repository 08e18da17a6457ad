#pragma once
#include <array>
#include <string>

#include "diagnose/decide/diagnosis.h"

namespace mcdem::inline report {

std::string verdict_headline(const Diagnosis& diagnosis);
std::string verdict_sentence(const Diagnosis& diagnosis);

struct VerdictLine {
    std::string about;  ///< Gap, Where, Which, How far, Limits, Next
    std::string says;
};

/// Existence and location of the gap, consistent effects, gap reduction, limits, and next steps.
std::array<VerdictLine, 6> verdict_lines(const Diagnosis& diagnosis);

/// The six lines, aligned, each with a line feed.
std::string diagnosis_text(const Diagnosis& diagnosis);

}  // namespace mcdem::report
