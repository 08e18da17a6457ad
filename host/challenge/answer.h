// The scored part of a diagnosis: the verdict and the named effects.
#pragma once
#include "diagnose/decide/decision.h"

namespace mcdem::inline challenge {

struct Answer {
    Verdict verdict = Verdict::no_gap;
    std::vector<std::string>
        group;  ///< named effects that cannot be distinguished, or both of a pair; the leading one first
    double confidence = 0;  ///< of the leading effect
    bool detected() const { return verdict != Verdict::no_gap; }
    /// Whether effects are named as the cause.
    bool names() const { return verdict == Verdict::effect || verdict == Verdict::group; }
};

Answer answer_of(const Findings& findings, const Limits& limits);

}  // namespace mcdem::challenge
