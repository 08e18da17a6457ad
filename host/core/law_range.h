// How far the laws of contact models were held against finite elements of a soft grain.
#pragma once
#include <optional>

#include "core/names.h"

namespace mcdem::inline core {

/// Geometric overlap of two grains over the sum of their radii up to which the law of a model meets finite
/// elements (tests/truth/README.md); none for models that do not.
constexpr std::optional<double> tested_overlap(ContactModel model) {
    switch (model) {
        case ContactModel::elastic_sphere:
            return 0.10;  // there finite strain adds 7 % to the force of six plates at nu = 0.49
        case ContactModel::hyperelastic_sphere:
            return 0.20;
        default:
            return std::nullopt;
    }
}

}  // namespace mcdem::core
