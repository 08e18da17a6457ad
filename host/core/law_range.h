// Range in which contact models were compared with finite elements of a soft grain.
#pragma once
#include <optional>

#include "core/names.h"

namespace mcdem::inline core {

/// Largest geometric overlap of two grains over the sum of their radii at which the model agrees with finite
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
