// Static forces of a contact model on one sphere between rigid frictionless plates. They are found by the
// same delayed iteration as in a simulation: forces displace the surface, which changes the forces. Radius
// and Young's modulus are 1.
#pragma once
#include <optional>
#include <vector>

#include "sim/reference/grain_reference.h"

namespace mcdem::reference {

struct Plate {
    Vec3 direction;
    double overlap;  ///< radius minus the distance of the plate from the centre
};

/// Force and surface displacement at each plate.
struct PlateSolution {
    std::vector<double> force, displacement;
};

/// Empty if the iteration diverges: there is no static solution, or an overlap exceeds `hopeless`.
inline std::optional<PlateSolution> solve_plates(const SurfaceLaw& law, double poisson_ratio,
                                                 const std::vector<Plate>& plates, double hopeless = 0.9) {
    constexpr double settled = 1e-11, relaxation = 0.5;
    Grain grain;
    grain.poisson_ratio = poisson_ratio;
    std::vector<double> delta;
    for (const Plate& plate : plates) {
        delta.push_back(plate.overlap);
        grain.slots.push_back({plate.direction.normalized(), 1 - plate.overlap});
    }
    for (int iteration = 0; iteration < 20000; ++iteration) {
        for (std::size_t c = 0; c < plates.size(); ++c) {
            const double overlap = std::max(delta[c], 0.0);  // without contact the arm ends at the plate
            grain.slots[c].force = 4.0 / 3 / (1 - poisson_ratio * poisson_ratio) * std::pow(overlap, 1.5);
            grain.slots[c].contact_radius = std::sqrt(overlap);
        }
        const auto moved = surface_displacement(law, grain);
        double change = 0;
        for (std::size_t c = 0; c < plates.size(); ++c) {
            const double step = plates[c].overlap + moved[c] - delta[c];
            change = std::max(change, std::abs(step));
            delta[c] += relaxation * step;
            if (!(delta[c] < hopeless)) return std::nullopt;
        }
        if (change > settled) continue;
        PlateSolution solution{{}, moved};
        for (const Slot& slot : grain.slots) solution.force.push_back(slot.force);
        return solution;
    }
    return std::nullopt;
}

}  // namespace mcdem::reference
