// Range in which contact models were compared with finite elements of a soft grain.
#pragma once
#include <algorithm>
#include <optional>

#include "core/names.h"

namespace mcdem::inline core {

/// Relative overlap of two grains: delta R*/R^2 with the smaller radius R, the square of Hertz's contact
/// radius a = sqrt(R* delta) over R. For equal grains it is the overlap over the sum of the radii, on a flat
/// wall that over the grain's radius. Strains of the smaller grain depend on it; the sum of the radii would
/// hide that a small grain vanishes between two large ones. `overlap`, `first` and `second` radius in the
/// same unit.
inline double relative_overlap(double overlap, double first, double second) {
    const double smaller = std::min(first, second), larger = std::max(first, second);
    return overlap / ((first + second) * (smaller / larger));
}

/// Largest relative geometric overlap of two grains at which the model agrees with finite
/// elements (tests/truth/README.md); none for models that do not agree.
constexpr std::optional<double> tested_overlap(ContactModel model) {
    switch (model) {
        case ContactModel::elastic_sphere:
            return 0.10;  // finite strain adds 7 % to the force of six plates at nu = 0.49 there
        case ContactModel::hyperelastic_sphere:
            return 0.20;
        default:
            return std::nullopt;
    }
}

}  // namespace mcdem::core
