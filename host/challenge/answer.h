// What is scored of a diagnosis: the verdict, and whom it names.
#pragma once
#include "diagnose/decide/decision.h"

namespace mcdem::inline challenge {

struct Answer {
    Verdict verdict = Verdict::no_gap;
    std::vector<std::string>
        group;              ///< named effects that cannot be told apart, or both of a pair; the leader first
    double confidence = 0;  ///< of the leader
    bool detected() const { return verdict != Verdict::no_gap; }
    /// Effects are named as the cause.
    bool names() const { return verdict == Verdict::effect || verdict == Verdict::group; }
};

Answer answer_of(const Findings& findings, const Limits& limits);

}  // namespace mcdem::challenge
