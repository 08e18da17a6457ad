// Residuals of each measured contact: the overlap implied by its force, the overlap of the measured
// positions, and the surface displacement by the other contacts of its two grains.
#pragma once
#include <vector>

#include "core/recording.h"

namespace mcdem::inline diagnose {

/// Material that the residuals assume; the same for all recordings that are compared.
struct ReferenceMaterial {
    double youngs_modulus = 0;  ///< grains [Pa]
    double poisson_ratio = 0.5;
    double wall_youngs_modulus = 0;  ///< [Pa]
    double wall_poisson_ratio = 0.5;
    double friction = 0;         ///< between grains
    double force_threshold = 0;  ///< as stated by the instrument [N]
};

/// Lengths over R* = R_i R_j / (R_i + R_j), or over R at a wall.
struct ContactResidual {
    int grain = 0, partner = 0;  ///< as in Contact
    Vec3 normal = Vec3::Zero();  ///< from grain to partner
    Vec3 force = Vec3::Zero();   ///< on grain [N]
    double normal_force = 0;     ///< normal force, positive for repulsion [N]
    double tangential = 0;       ///< magnitude of the tangential force [N]
    double reduced_radius = 0;   ///< R* [m]
    double implied = 0;          ///< overlap at which Hertz's law gives the force; negative for attraction
    double measured = 0;         ///< overlap of the measured spheres; negative for a gap
    double cross_contact = 0;    ///< sum of delta_kc of both grains [paper, Eq. 1 with gamma = 1]
    double residual() const { return implied - measured; }
};

/// For the contacts of a scan with positions.
std::vector<ContactResidual> contact_residuals(const Recording& recording, const Scan& scan,
                                               const ReferenceMaterial& material);

}  // namespace mcdem::diagnose
