#include "ensemble/diagnosis/outside_effects.h"

#include <algorithm>

namespace mcdem::inline ensemble {
namespace {

void stretch_heights(Recording& recording, double amplitude) {
    for (Scan& scan : recording.scans) {
        for (Vec3& position : scan.position) position.z() *= 1 + amplitude;
        for (Contact& contact : scan.contacts) contact.point.z() *= 1 + amplitude;
    }
}

void add_backlash(Recording& recording, double amplitude) {
    for (Scan& scan : recording.scans)
        if (scan.phase == Phase::unload) scan.plate_z += amplitude;
}

// clang-format off
const OutsideEffect table[] = {
    // Young's modulus of the walls over that of the grains
    {"soft_walls", 0.5, 3, false, [](Replica& r, double a) { r.walls.youngs_modulus = a * r.grains.youngs_modulus; }, nullptr},
    // part by which the heights of grains, not of the plate, are read too large
    {"vertical_stretch", 0.005, 0.015, true, nullptr, stretch_heights},
    // part by which the box is narrower along x than stated
    {"box_error", 0.007, 0.02, false, [](Replica& r, double a) { r.box.size_x *= 1 - a; }, nullptr},
    // by which the plate is read too high while it goes up [m]
    {"plate_backlash", 0.5e-3, 1.5e-3, true, nullptr, add_backlash},
};
// clang-format on

}  // namespace

std::span<const OutsideEffect> outside_effects() { return table; }

const OutsideEffect* find_outside_effect(std::string_view name) {
    const auto found = std::ranges::find(table, name, &OutsideEffect::name);
    return found == std::end(table) ? nullptr : found;
}

}  // namespace mcdem::ensemble
