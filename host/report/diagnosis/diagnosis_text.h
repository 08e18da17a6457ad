// The verdict of a diagnosis in words.
#pragma once
#include <array>
#include <string>

#include "diagnose/decide/diagnosis.h"

namespace mcdem::inline report {

/// The verdict as a title.
std::string verdict_headline(const Diagnosis& diagnosis);

/// One sentence.
std::string verdict_sentence(const Diagnosis& diagnosis);

/// What a line is about, and what it says.
struct VerdictLine {
    std::string about;  ///< Gap, Where, Which, How far, Limits, Next
    std::string says;
};

/// Is there a gap, where, which effects is it consistent with, how far does it shrink, what cannot be
/// told, and what to do next.
std::array<VerdictLine, 6> verdict_lines(const Diagnosis& diagnosis);

/// The six lines, aligned, each ended by a line feed.
std::string diagnosis_text(const Diagnosis& diagnosis);

}  // namespace mcdem::report
