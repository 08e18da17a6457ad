// Diagnoses as they may come out, one for each verdict: made up, but with the size and spread of real ones.
#pragma once
#include "diagnose/decide/diagnosis.h"

namespace mcdem::samples {

/// 25 observables at 5 displacements of loading and of unloading, 18 candidates.
Diagnosis diagnosis(Verdict verdict);

inline constexpr std::array all_verdicts{Verdict::no_gap,        Verdict::effect,
                                         Verdict::group,         Verdict::unknown_effect,
                                         Verdict::not_converged, Verdict::calibration_suspect};

/// Every text of it replaced by `text`.
Diagnosis with_texts(Diagnosis diagnosis, const std::string& text);

}  // namespace mcdem::samples
