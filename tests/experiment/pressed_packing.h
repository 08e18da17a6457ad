// Grains on a shaken lattice in a box, pressed by a plate and let go: forces by Hertz's law from their
// overlaps.
#pragma once
#include <cmath>

#include "experiment/experiment.h"
#include "scene/random.h"

namespace mcdem::test {

/// Box, materials and name of the experiment; nothing measured yet.
inline Experiment known_of_pressed_packing() {
    Experiment known;
    known.name = "pressed";
    known.materials = {{"grains.youngs_modulus", 23300}, {"grains.poisson_ratio", 0.5}};
    known.recording.box = {0.06, 0.08};
    known.recording.plate_start = std::nan("");
    return known;
}

inline void add_contacts(const Recording& recording, Scan& scan) {
    const double modulus = 23300 / 0.75;
    const auto add = [&](int i, int partner, const Vec3& line, double overlap, double radius,
                         double stiffness, const Vec3& point) {
        if (overlap > 0)
            scan.contacts.push_back({i, partner, point,
                                     4.0 / 3 * stiffness * std::sqrt(radius) * std::pow(overlap, 1.5) * line,
                                     std::nan("")});
    };
    const int grains = static_cast<int>(scan.position.size());
    for (int i = 0; i < grains; ++i) {
        const Vec3& at = scan.position[static_cast<std::size_t>(i)];
        const double r = recording.diameter[static_cast<std::size_t>(i)] / 2;
        for (int j = i + 1; j < grains; ++j) {
            const Vec3 line = at - scan.position[static_cast<std::size_t>(j)];
            const double other = recording.diameter[static_cast<std::size_t>(j)] / 2, distance = line.norm();
            add(i, j, line / distance, r + other - distance, r * other / (r + other), modulus / 2,
                at - line / distance * (r + distance - other) / 2);
        }
        const double walls[] = {0, recording.box.size_x, 0, recording.box.size_y, 0, scan.plate_z};
        for (int w = 0; w < 6; ++w) {
            Vec3 foot = at;
            foot[w / 2] = walls[w];
            const double sign = w % 2 == 0 ? 1 : -1;
            add(i, wall_partner(static_cast<Wall>(w)), sign * Vec3::Unit(w / 2),
                r - sign * (at[w / 2] - walls[w]), r, modulus, foot);
        }
    }
    for (const Contact& contact : scan.contacts)
        if (contact.partner == wall_partner(Wall::plate))
            scan.wall_force[static_cast<std::size_t>(Wall::plate)].z() -= contact.force.z();
}

/// 3 x 4 x 3 grains about 20 mm wide, seven frames of one stroke down and up.
inline Recording pressed_packing() {
    Recording recording;
    recording.box = {0.06, 0.08};
    recording.plate_start = 0.0605;
    Random random(7, Stream::positions);
    std::vector<Vec3> lattice;
    for (int n = 0; n < 36; ++n) {
        lattice.emplace_back(n % 3 + 0.5 + random.uniform(-0.02, 0.02),
                             n / 3 % 4 + 0.5 + random.uniform(-0.02, 0.02),
                             n / 12 + 0.5 + random.uniform(-0.02, 0.02));
        recording.diameter.push_back(0.0207 + random.uniform(-3e-4, 3e-4));
    }
    const double heights[] = {0.0605, 0.059, 0.057, 0.055, 0.0565, 0.0585, 0.0602};
    for (int f = 0; f < 7; ++f) {
        Scan scan;
        scan.frame = f;
        scan.plate_z = heights[f];
        scan.phase = f < 4 ? Phase::load : Phase::unload;
        for (const Vec3& at : lattice)
            scan.position.emplace_back(0.02 * at.x(), 0.02 * at.y(), heights[f] / 3 * at.z());
        add_contacts(recording, scan);
        recording.scans.push_back(std::move(scan));
    }
    return recording;
}

}  // namespace mcdem::test
