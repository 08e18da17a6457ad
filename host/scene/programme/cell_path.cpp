#include "scene/programme/cell_path.h"

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

CellMove::CellMove(const Stage& stage, const Strain& before, double begin)
    : from(before), to(strain_after(stage, before)), begin(begin) {
    double most = 0;
    for (std::size_t k = 0; k < to.size(); ++k) most = std::max(most, std::abs(to[k] - from[k]));
    end = begin + most;
}

Strain CellMove::strain(double place) const {
    const double way = end - begin;
    const double part = way > 0 ? std::clamp((place - begin) / way, 0.0, 1.0) : 1;
    if (part == 1) return to;
    Strain strain = from;
    for (std::size_t k = 0; k < strain.size(); ++k) strain[k] += part * (to[k] - strain[k]);
    return strain;
}

Strain CellMove::direction() const {
    const double way = end - begin;
    Strain direction{};
    for (std::size_t k = 0; way > 0 && k < direction.size(); ++k) direction[k] = (to[k] - from[k]) / way;
    return direction;
}

bool CellMove::loads() const {
    const auto volume = [](const Strain& s) { return (1 - s[0]) * (1 - s[1]) * (1 - s[2]); };
    const auto shear = [](const Strain& s) { return s[3] * s[3] + s[4] * s[4] + s[5] * s[5]; };
    const double change = volume(to) - volume(from);
    return change < 0 || (change == 0 && shear(to) >= shear(from));
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
