// Artificial scans with given grains and contact forces.
#pragma once
#include "diagnose/observe/contact_residuals.h"

namespace mcdem {

inline ReferenceMaterial soft_material() {
    ReferenceMaterial material;
    material.youngs_modulus = 20e3;
    material.poisson_ratio = 0.5;
    material.wall_youngs_modulus = 60e3;  // not much stiffer than the grains, so that its compliance matters
    material.wall_poisson_ratio = 0.3;
    material.friction = 0.03;
    return material;
}

/// `n`^3 grains on a cubic lattice between the walls, with contacts to all neighbours and walls.
class Lattice {
public:
    static constexpr double edge = 0.02;  ///< [m]

    explicit Lattice(int n, double diameter = 1.02 * edge) : n_(n) {
        recording.box = {n * edge, n * edge};
        recording.plate_start = n * edge;
        scan.plate_z = n * edge;
        recording.diameter.assign(static_cast<std::size_t>(n) * n * n, diameter);
        for (int z = 0; z < n; ++z)
            for (int y = 0; y < n; ++y)
                for (int x = 0; x < n; ++x) scan.position.push_back(edge * Vec3(x + 0.5, y + 0.5, z + 0.5));
        for (int grain = 0; grain < n * n * n; ++grain) add_contacts(grain);
    }

    Recording recording;  ///< without scans
    Scan scan;            ///< all contacts have 10 mN; the plate's force is their sum

private:
    static constexpr double push_ = 0.01;

    void add_contacts(int grain) {
        const int place[] = {grain % n_, grain / n_ % n_, grain / n_ / n_};
        const int step[] = {1, n_, n_ * n_};
        for (int axis = 0; axis < 3; ++axis) {
            const Vec3 half = 0.5 * edge * Vec3::Unit(axis);
            const Vec3& centre = scan.position[static_cast<std::size_t>(grain)];
            if (place[axis] == 0) add({grain, -1 - 2 * axis, centre - half, push_ * Vec3::Unit(axis)});
            if (place[axis] == n_ - 1) add({grain, -2 - 2 * axis, centre + half, -push_ * Vec3::Unit(axis)});
            if (place[axis] < n_ - 1)
                add({grain, grain + step[axis], centre + half, -push_ * Vec3::Unit(axis)});
        }
    }

    void add(const Contact& contact) {
        scan.contacts.push_back(contact);
        if (contact.partner == wall_partner(Wall::plate))
            scan.wall_force[static_cast<int>(Wall::plate)] -= contact.force;
    }

    int n_;
};

}  // namespace mcdem
