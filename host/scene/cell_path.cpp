#include "scene/cell_path.h"

#include <algorithm>
#include <cmath>

#include "core/container.h"

namespace mcdem::inline scene {

Strain strain_after(const Stage& stage, Strain before) {
    if (stage.kind != StageKind::move) return before;
    if (!std::isnan(stage.strain)) std::fill_n(before.begin(), 3, stage.strain);
    const double given[]{stage.strain_x, stage.strain_y, stage.strain_z,
                         stage.shear_xy, stage.shear_xz, stage.shear_yz};
    for (std::size_t k = 0; k < before.size(); ++k)
        if (!std::isnan(given[k])) before[k] = given[k];
    return before;
}

CellPath::CellPath(const std::vector<Stage>& stages, const std::vector<Leg>& legs)
    : strain_{Strain{}}, length_{0} {
    for (const Leg& leg : legs) {
        const Strain& before = strain_.back();
        const Strain after = strain_after(stages[static_cast<std::size_t>(leg.stage)], before);
        double most = 0;
        for (std::size_t k = 0; k < after.size(); ++k) most = std::max(most, std::abs(after[k] - before[k]));
        length_.push_back(length_.back() + most);
        strain_.push_back(after);
    }
}

Strain CellPath::strain(int leg, double place) const {
    const auto at = static_cast<std::size_t>(leg);
    const double way = length_[at + 1] - length_[at];
    const double part = way > 0 ? std::clamp((place - length_[at]) / way, 0.0, 1.0) : 1;
    if (part == 1) return strain_[at + 1];
    Strain strain = strain_[at];
    for (std::size_t k = 0; k < strain.size(); ++k) strain[k] += part * (strain_[at + 1][k] - strain[k]);
    return strain;
}

Strain CellPath::direction(int leg) const {
    const auto at = static_cast<std::size_t>(leg);
    const double way = length_[at + 1] - length_[at];
    Strain direction{};
    for (std::size_t k = 0; way > 0 && k < direction.size(); ++k)
        direction[k] = (strain_[at + 1][k] - strain_[at][k]) / way;
    return direction;
}

bool CellPath::loads(int leg) const {
    const auto volume = [](const Strain& s) { return (1 - s[0]) * (1 - s[1]) * (1 - s[2]); };
    const auto shear = [](const Strain& s) { return s[3] * s[3] + s[4] * s[4] + s[5] * s[5]; };
    const Strain &before = strain_[static_cast<std::size_t>(leg)],
                 &after = strain_[static_cast<std::size_t>(leg) + 1];
    const double change = volume(after) - volume(before);
    return change < 0 || (change == 0 && shear(after) >= shear(before));
}

Box smallest_cell(const Replica& replica) {
    Strain strain{}, most{};
    for (const Stage& stage : replica.programme) {
        strain = strain_after(stage, strain);
        for (std::size_t k = 0; k < 3; ++k) most[k] = std::max(most[k], strain[k]);
    }
    return deformed(replica.box, most);
}

}  // namespace mcdem::scene
