// Diagnoses without a part of the method, and simpler methods, to measure the value of each part.
#pragma once
#include <span>

#include "challenge/merits.h"
#include "diagnose/infer/evidence.h"

namespace mcdem::inline challenge {

/// The method with modified evidence, without confirming runs.
struct Ablation {
    std::string_view name;
    std::string_view meaning;
    void (*change)(Evidence&);
};
std::span<const Ablation> ablations();

/// Findings of the modified evidence; no candidates if it is not sufficient for a diagnosis.
Findings ablated_findings(Evidence evidence, const Ablation& ablation);

/// Another method on the same evidence.
struct SimplerMethod {
    std::string_view name;
    std::string_view meaning;
    Answer (*answer)(const Evidence&);
};
std::span<const SimplerMethod> simpler_methods();

}  // namespace mcdem::challenge
