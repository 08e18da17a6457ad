// Each measured contact against the model: the overlap that its force implies, the overlap that the measured
// positions show, and what the other contacts of its two grains push the surfaces out by.
#pragma once
#include <vector>

#include "core/recording.h"

namespace mcdem::inline diagnose {

/// What the model takes the materials to be: the same for every recording that is compared.
struct ReferenceMaterial {
    double youngs_modulus = 0;  ///< grains [Pa]
    double poisson_ratio = 0.5;
    double wall_youngs_modulus = 0;  ///< [Pa]
    double wall_poisson_ratio = 0.5;
    double friction = 0;  ///< grain on grain
    double wall_friction = 0;
    double weight_density = 0;   ///< (density - fluid density) g [N/m3]
    double force_threshold = 0;  ///< stated by the instrument [N]
};

/// Lengths over R* = R_i R_j / (R_i + R_j), or over R at a wall.
struct ContactResidual {
    int grain = 0, partner = 0;  ///< as in Contact
    Vec3 normal = Vec3::Zero();  ///< from grain to partner
    Vec3 force = Vec3::Zero();   ///< on grain [N]
    double push = 0;             ///< normal force, positive where the two push each other apart [N]
    double tangential = 0;       ///< size of the tangential force [N]
    double reduced_radius = 0;   ///< R* [m]
    double implied = 0;          ///< overlap for which Hertz gives the force; negative for a pull
    double measured = 0;         ///< overlap of the measured spheres; negative for a gap
    double cross_contact = 0;    ///< sum of delta_kc of both grains [paper, Eq. 1 with gamma = 1]
    double residual() const { return implied - measured; }
};

/// Contacts of a scan that has positions.
std::vector<ContactResidual> contact_residuals(const Recording& recording, const Scan& scan,
                                               const ReferenceMaterial& material);

}  // namespace mcdem::diagnose
