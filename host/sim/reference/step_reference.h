// Reference for the kernels: one time step of a replica in double precision, written in vector form directly
// from the published formulas. It loops over all pairs of grains.
#pragma once
#include <array>
#include <map>
#include <vector>

#include "core/packing.h"
#include "elasticity/surface_displacement.h"
#include "scene/scene.h"

namespace mcdem::reference {

using mcdem::Vec3;

/// Component of `v` perpendicular to the unit vector e.
inline Vec3 across(const Vec3& v, const Vec3& e) { return v - v.dot(e) * e; }

/// State of a contact that a grain stores between steps.
struct Memory {
    double predicted = 0;          ///< surface displacement extrapolated to the next step [m]
    std::array<double, 4> past{};  ///< .. by the forces of each of the last four steps, latest first
    Vec3 spring = Vec3::Zero();    ///< force of the tangential spring of Mindlin friction [N]
    double contact_radius = 0;     ///< that the stiffness of the springs follows [m]
    double deepest = 0;            ///< largest overlap so far (plasticity) [m]
    double relaxed = 0;            ///< internal variable q (viscoelasticity) [N]
    Vec3 rolling = Vec3::Zero();   ///< couple of the rolling spring [N m]
};

/// A neighbour of a grain and its contact.
struct ReferenceContact {
    int grain = 0;
    int partner = 0;                 ///< a grain, or mcdem::wall_partner
    Vec3 direction = Vec3::Zero();   ///< e, from the grain outward
    double overlap = 0;              ///< corrected; zero without contact [m]
    double contact_radius = 0;       ///< a [m]
    double elastic = 0;              ///< Hertz force including stiffening [N]
    double energy = 0;               ///< stored in the contact [J]
    double spring_energy = 0;        ///< stored in the springs of friction and rolling resistance [J]
    double displacement = 0;         ///< displacement of the grain's own surface [m]
    double arm = 0;                  ///< centre to contact point, or to the probed surface point [m]
    Vec3 tangential = Vec3::Zero();  ///< friction on the grain [N]
    Vec3 couple = Vec3::Zero();      ///< rolling resistance on the grain [N m]
    Vec3 force = Vec3::Zero();       ///< total force on the grain [N]
};

struct Totals {
    double kinetic_energy = 0, elastic_energy = 0, deepest_overlap = 0;
    std::array<Vec3, 6> wall_force;
};

class StepReference {
public:
    /// Starts at rest. Computes the time step and the lengths that the scene gives as fractions.
    StepReference(const mcdem::Replica& scene, const mcdem::Packing& packing);

    std::vector<Vec3> position, velocity, angular_velocity;  ///< velocities are half a step behind
    std::vector<std::map<int, Memory>> memory;               ///< grain -> partner -> memory

    double time_step() const { return time_step_; }
    void set_time_step(double time_step) { time_step_ = time_step; }
    /// In float the contact radius of springs decreases only when the contact's is this fraction below it.
    void set_radius_slack(double slack) { radius_slack_ = slack; }
    double reach() const { return reach_; }  ///< largest gap of a neighbour in the list [m]
    double mass(int grain) const;

    /// Position and velocity of the plate in the following steps; drag in addition to the scene's.
    void begin(double plate_z, double plate_velocity = 0, double settle_drag = 0);
    /// Lists all pairs within reach; keeps the memory of pairs that were in the list.
    void list_neighbours();
    void step();
    /// All neighbours of all grains in the present state, touching or not.
    std::vector<ReferenceContact> neighbours() const;
    Totals totals() const;

    /// Linear and angular acceleration of every grain by these contacts (of each grain, in any order), weight
    /// and drag.
    struct Accelerations {
        std::vector<Vec3> linear, angular;
    };
    Accelerations accelerations(const std::vector<ReferenceContact>& contacts) const;

private:
    struct Body {
        Vec3 position, velocity, angular_velocity;
        double radius, mass;
        double youngs_modulus;  ///< of this grain, including its excess compliance [Pa]
        int species = -1;       ///< -1: a wall
        const mcdem::SurfaceLaw* law = nullptr;
        double curvature = 0;  ///< of a cylinder's wall, which is concave: negative [1/m]
    };
    /// Constants of a pair of bodies.
    struct PairConstants {
        double modulus, shear_modulus;  ///< E*, G* [Pa]
        double radius, mass;            ///< R* [m], m* [kg]
        double damping;                 ///< 2 sqrt(5/6) beta
        double friction;                ///< mu
    };
    Body body(int grain) const;
    Body partner_of(int grain, int partner) const;
    PairConstants pair_constants(const Body& a, const Body& b) const;
    double poisson_ratio(const Body& body) const;
    std::array<double, 2> friction_and_restitution(const Body& a, const Body& b) const;
    double distance_to(int grain, int partner) const;
    double self_consistent_overlap(double given, const Body& a, const Body& b,
                                   const PairConstants& pair) const;
    double self_compliance(double contact_radius, const Body& body) const;
    double counted_displacements(double geometric, double displacements) const;
    double plastic_overlap(double overlap, double& deepest) const;
    ReferenceContact contact_of(int grain, int partner, double elapsed, Memory& memory) const;
    void add_forces(ReferenceContact& contact, const Body& a, const Body& b, const PairConstants& pair,
                    double elapsed, Memory& memory) const;
    struct Attraction {
        double force = 0, energy = 0;  ///< [N], [J]
    };
    Attraction attraction(double overlap, const PairConstants& pair) const;
    Vec3 direction_before(const ReferenceContact& contact, const Body& a, const Body& b,
                          double elapsed) const;
    void carry_springs(const ReferenceContact& contact, const Body& a, const Body& b, double elapsed,
                       Memory& memory) const;
    Vec3 rolling_couple(double normal, const Body& a, const Body& b, const PairConstants& pair,
                        double elapsed, Memory& memory) const;
    Vec3 saturated_friction(double limit, const Vec3& sliding, const PairConstants& pair) const;
    Vec3 mindlin_friction(double limit, const Vec3& sliding, const PairConstants& pair, double elapsed,
                          Memory& memory) const;
    void displace_surfaces(const std::vector<std::vector<ReferenceContact>>& contact);
    double displacement_energy() const;  ///< [J]

    mcdem::Replica scene_;
    std::vector<mcdem::GrainMaterial> material_;  ///< of each grain
    std::vector<mcdem::SurfaceLaw> law_;          ///< of each grain
    std::vector<double> radius_, youngs_modulus_;
    std::vector<int> species_;
    double time_step_ = 0, reach_ = 0, probe_gap_ = 0;
    double plate_z_ = 0, plate_velocity_ = 0, drag_ = 0, spin_drag_ = 0, radius_slack_ = 0;
};

}  // namespace mcdem::reference
