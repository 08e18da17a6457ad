// Invariants of stress and strain as in soil mechanics: p, q, and their work-conjugate strains.
#pragma once
#include "core/recording.h"

namespace mcdem::inline metrics {

/// p, one third of the trace [Pa]; compression positive.
double mean_stress(const Mat3& stress);

/// q = sqrt(3/2 s:s) of the symmetric deviator s: |sigma_1 - sigma_3| if two principal stresses are equal
/// [Pa].
double deviatoric_stress(const Mat3& stress);

/// Decrease of a cell's volume over its initial volume.
double volume_strain(const Strain& strain);

/// eps_q = sqrt(2/3 e:e) of the logarithmic strain's deviator e: 2/3 |eps_1 - eps_3| if two principal strains
/// are equal; a small shear over sqrt(3).
double deviatoric_strain(const Strain& strain);

/// What a scan is loaded by: the force on the plate [N], of a cell its mean stress [Pa].
double load(const Recording& recording, const Scan& scan);

/// The scan of the largest load; none where no scan has one.
std::optional<std::size_t> strongest_scan(const Recording& recording);

}  // namespace mcdem::metrics
