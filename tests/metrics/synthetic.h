// Recordings with known results: forces, contacts and averages are simple functions of the displacement.
#pragma once
#include <cmath>
#include <random>
#include <string>

#include "core/parameters.h"
#include "core/recording.h"

namespace mcdem::synthetic {

struct Law {
    std::string model = "mc_dem";
    int seed = 1;
    int cycles = 1;
    int levels = 10;          ///< scans per stroke, the last at full stroke
    double stroke = 30e-3;    ///< [m]
    double top = 15;          ///< top force at full stroke while loading [N]
    double hysteresis = 0.1;  ///< fraction of the force lost while unloading
    double touch = 5e-3;      ///< displacement at first contact [m]
    double scatter = 0;       ///< relative standard deviation of the force between seeds
    int grains = 100;
    int contacts = 0;           ///< between grains, in each scan; 0: not recorded
    double mean_force = 50e-3;  ///< of the contact forces at full stroke [N]
    double shape = 1;           ///< of the gamma distribution of contact forces
};

inline double share_of_stroke(const Law& law, double displacement) {
    return std::max(0.0, (displacement - law.touch) / (law.stroke - law.touch));
}

inline void add_contacts(const Law& law, double strain, std::mt19937_64& random, Scan& scan) {
    std::gamma_distribution<double> draw(law.shape, 1 / law.shape);
    const double mean = law.mean_force * (0.1 + 0.9 * strain);
    for (int c = 0; c < law.contacts; ++c) {
        Contact contact;
        contact.grain = c % law.grains;
        contact.partner = c % 10 == 9 ? wall_partner(Wall::floor) : (c + 1) % law.grains;
        contact.force = {0, 0, mean * draw(random)};
        scan.contacts.push_back(contact);
    }
}

inline Scan scan_at(const Law& law, Phase phase, double displacement, double factor,
                    std::mt19937_64& random) {
    Scan scan;
    scan.phase = phase;
    scan.plate_z = 0.17 - displacement;
    const double strain = share_of_stroke(law, displacement);
    const double lost = phase == Phase::unload ? 1 - law.hysteresis : 1;
    const double force = law.top * factor * lost * std::pow(strain, 1.5);
    scan.wall_force[static_cast<int>(Wall::plate)] = {0, 0, force};
    scan.coordination_number = 6 + 2 * strain;
    scan.packing_fraction = 0.6 + 0.1 * strain;
    scan.branch_length = 0.0215 - 0.001 * strain;
    scan.mean_force =
        0.1 * force / (scan.coordination_number * scan.packing_fraction * scan.branch_length * 15);
    add_contacts(law, strain, random, scan);
    return scan;
}

inline Recording recording(const Law& law) {
    std::mt19937_64 random(law.seed * 7919 + 17);
    Recording made;
    made.label = without_quotes(law.model) + " #" + std::to_string(law.seed);
    made.parameters = {{"contact.model", law.model}, {"packing.seed", std::to_string(law.seed)}};
    made.plate_start = 0.17;
    made.diameter.assign(law.grains, 0.0215);
    const double factor = 1 + law.scatter * std::normal_distribution<double>()(random);
    for (int cycle = 0; cycle < law.cycles; ++cycle)
        for (int i = 1; i <= 2 * law.levels; ++i) {
            const bool loading = i <= law.levels;
            const double share = (loading ? i : 2 * law.levels - i) / static_cast<double>(law.levels);
            auto scan =
                scan_at(law, loading ? Phase::load : Phase::unload, law.stroke * share, factor, random);
            scan.frame = static_cast<int>(made.scans.size());
            scan.cycle = cycle;
            made.scans.push_back(std::move(scan));
        }
    return made;
}

/// A cell of 0.1 m that is compressed by 2 % along all axes, then sheared by 10 % in the plane xz, then
/// held. Its pressure p is 1 kPa times volume strain over 0.01; while sheared it has a shear stress of p/10.
inline Recording cell(const std::string& model, int seed = 1, double factor = 1) {
    Recording made;
    made.label = model + " #" + std::to_string(seed);
    made.parameters = {{"contact.model", model},
                       {"packing.seed", std::to_string(seed)},
                       {"programme.1.stage", "\"move\""},
                       {"programme.2.stage", "\"move\""},
                       {"programme.3.stage", "\"hold\""}};
    made.box = {0.1, 0.1, ContainerShape::cell, 0.1};
    made.plate_start = 0.1;
    made.diameter.assign(20, 0.02);
    const Strain strains[]{{0.01, 0.01, 0.01, 0, 0, 0},
                           {0.02, 0.02, 0.02, 0, 0, 0},
                           {0.02, 0.02, 0.02, 0, 0.1, 0},
                           {0.02, 0.02, 0.02, 0, 0.1, 0}};
    for (const Strain& strain : strains) {
        Scan scan;
        scan.frame = static_cast<int>(made.scans.size());
        scan.time = 0.5 + scan.frame;
        scan.strain = strain;
        scan.plate_z = 0.1 * (1 - strain[2]);
        const double p = factor * 1e5 * (1 - std::pow(1 - strain[0], 3));
        scan.stress = p * Mat3::Identity();
        if (strain[4] > 0) scan.stress(0, 2) = scan.stress(2, 0) = -0.1 * p;
        scan.coordination_number = 6;
        scan.packing_fraction = 0.6 + strain[0];
        scan.rate_error = 0.004;
        made.scans.push_back(scan);
    }
    return made;
}

/// One run with `replicas` seeds of each setting.
inline Run run(const std::vector<Law>& laws, int replicas) {
    Run made;
    made.name = "synthetic";
    for (auto law : laws)
        for (int seed = 1; seed <= replicas; ++seed) {
            law.seed = seed;
            made.recordings.push_back(recording(law));
        }
    return made;
}

}  // namespace mcdem::synthetic
