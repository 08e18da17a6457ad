// Invariants of stress and strain, as soil mechanics has them: p, q, and what works with each.
#pragma once
#include "core/recording.h"

namespace mcdem::inline metrics {

/// p, a third of the trace [Pa]; compression positive.
double mean_stress(const Mat3& stress);

/// q = sqrt(3/2 s:s) of the symmetric deviator s: |sigma_1 - sigma_3| where two principal stresses are alike
/// [Pa].
double deviatoric_stress(const Mat3& stress);

/// Part of a cell's volume at start that is gone.
double volume_strain(const Strain& strain);

/// eps_q = sqrt(2/3 e:e) of the logarithmic strain's deviator e: 2/3 |eps_1 - eps_3| where two principal
/// strains are alike, a small shear over sqrt(3).
double deviatoric_strain(const Strain& strain);

/// What a scan is loaded by: the force on the plate [N], of a cell its mean stress [Pa].
double load(const Recording& recording, const Scan& scan);

/// The scan of the largest load; none where no scan has one.
std::optional<std::size_t> strongest_scan(const Recording& recording);

}  // namespace mcdem::metrics
