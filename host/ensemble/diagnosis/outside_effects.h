// Effects of simulated experiments that are in no library: a diagnosis should not name a library effect for
// them.
#pragma once
#include <span>
#include <string_view>

#include "core/recording.h"
#include "scene/scene.h"

namespace mcdem::inline ensemble {

struct OutsideEffect {
    std::string_view name;
    double low, high;  ///< range of amplitudes, log-uniform
    bool both_signs;
    void (*change_model)(Replica&, double amplitude);  ///< before the simulation; may be null
    void (*change_reading)(Recording&,
                           double amplitude);  ///< after it, before the instrument's noise; may be null
};

std::span<const OutsideEffect> outside_effects();
const OutsideEffect* find_outside_effect(std::string_view name);

}  // namespace mcdem::ensemble
