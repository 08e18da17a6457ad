// Grains under prescribed forces and stresses, with the largest relative overshoot in any interval. Packings
// without friction rearrange suddenly.
#pragma once
#include <fmt/format.h>

#include "sim/traced_programme.h"

namespace mcdem::reference {

struct Kind {
    const char* name;
    std::vector<std::string> overrides;
    bool rough = true;
    double stress_beyond = 1e-3;
    double force_beyond() const { return rough ? 1e-3 : 0.03; }
    /// From a stress while strains change.
    double stress_off() const { return rough ? 0.01 : 0.13; }
    std::vector<std::string> with(const std::string& seed, bool walls = false) const {
        auto all = overrides;
        all.push_back(rough ? "grains.friction=0.3" : "grains.friction=0");
        if (rough) all.push_back("contact.friction_law=mindlin");
        if (!rough && walls) all.push_back("walls.friction=0");
        all.push_back(seed);
        return all;
    }
};

inline const Kind control_kinds[] = {
    {"independent", {"contact.model=independent"}, false, 0.05},
    {"mc_dem", {}, false, 0.05},
    {"friction", {"contact.model=independent"}},
    {"mc_dem, friction", {}},
    {"elastic_sphere", {"contact.model=elastic_sphere"}},
    {"viscoelastic", {"effects.viscoelasticity=0.4", "effects.relaxation_time=0.05"}},
    {"plastic", {"effects.plasticity=0.3"}, true, 3e-3},
};

inline std::string test_name(const testing::TestParamInfo<Kind>& kind) {
    std::string name = kind.param.name;
    std::erase_if(name, [](char c) { return c == ',' || c == ' '; });
    return name;
}

/// Viscoelastic grains that do not slide past each other.
inline std::vector<std::string> creeping(double relaxation_time) {
    return {"effects.viscoelasticity=0.4", fmt::format("effects.relaxation_time={}", relaxation_time),
            "grains.friction=0.3", "contact.friction_law=mindlin"};
}

}  // namespace mcdem::reference
