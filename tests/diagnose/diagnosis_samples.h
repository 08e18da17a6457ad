// Artificial diagnoses, one for each verdict, of the size and with the scatter of real ones.
#pragma once
#include "diagnose/decide/diagnosis.h"

namespace mcdem::samples {

/// 25 observables at 5 displacements of loading and of unloading, 18 candidates.
Diagnosis diagnosis(Verdict verdict);

inline constexpr std::array all_verdicts{Verdict::no_gap,        Verdict::effect,
                                         Verdict::group,         Verdict::unknown_effect,
                                         Verdict::not_converged, Verdict::calibration_suspect};

/// Replaces every text by `text`.
Diagnosis with_texts(Diagnosis diagnosis, const std::string& text);

}  // namespace mcdem::samples
