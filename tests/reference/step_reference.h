// One step of a replica in double precision, written in vector form from the formulas of the paper and of the
// effects, with every pair of grains looked at: what the kernels are checked against.
#pragma once
#include <array>
#include <map>
#include <vector>

#include "core/packing.h"
#include "elasticity/surface_displacement.h"
#include "scene/scene.h"

namespace reference {

using mcdem::Vec3;

/// What a grain remembers of one neighbour from step to step.
struct Memory {
    double predicted = 0;          ///< surface displacement there, for the coming step [m]
    std::array<double, 4> past{};  ///< .. as the forces of the last four steps made it, the latest first
    Vec3 spring = Vec3::Zero();    ///< tangential, Mindlin friction [m]
    double deepest = 0;            ///< overlap so far, plasticity [m]
    double relaxed = 0;            ///< force, viscoelasticity [N]
};

/// One neighbour as seen from one grain.
struct Seen {
    int grain = 0;
    int partner = 0;                 ///< a grain, or mcdem::wall_partner
    Vec3 direction = Vec3::Zero();   ///< e, from the grain outward
    double overlap = 0;              ///< corrected; zero where there is no contact [m]
    double contact_radius = 0;       ///< a [m]
    double elastic = 0;              ///< Hertz force, stiffened [N]
    double energy = 0;               ///< stored in the contact [J]
    double bulge = 0;                ///< of the grain's own surface [m]
    double arm = 0;                  ///< centre to contact point, or to the probed surface point [m]
    Vec3 tangential = Vec3::Zero();  ///< friction on the grain [N]
    Vec3 couple = Vec3::Zero();      ///< rolling resistance on the grain [N m]
    Vec3 force = Vec3::Zero();       ///< on the grain, all together [N]
};

struct Totals {
    double kinetic_energy = 0, elastic_energy = 0, deepest_overlap = 0;
    std::array<Vec3, 6> wall_force;
};

class StepReference {
public:
    /// Starts at rest. Time step and lengths that the scene gives as fractions are worked out here.
    StepReference(const mcdem::Replica& scene, const mcdem::Packing& packing);

    std::vector<Vec3> position, velocity, angular_velocity;  ///< velocities stand half a step before
    std::vector<std::map<int, Memory>> memory;               ///< grain -> partner -> memory

    double time_step() const { return time_step_; }
    void set_time_step(double time_step) { time_step_ = time_step; }
    double reach() const { return reach_; }  ///< gap up to which a neighbour is listed [m]
    double mass(int grain) const;

    /// For the steps that follow: where the plate is now, how fast it moves, drag on top of the scene's.
    void begin(double plate_z, double plate_velocity = 0, double settle_drag = 0);
    /// Every pair within reach; what was remembered stays with a neighbour that is still there.
    void list_neighbours();
    void step();
    /// Every grain's neighbours as they are now, touching or not.
    std::vector<Seen> neighbours() const;
    Totals totals() const;

private:
    struct Body {
        Vec3 position, velocity, angular_velocity;
        double radius, mass;
        double youngs_modulus;  ///< of this very body [Pa]
        int species = -1;       ///< -1: a wall
        const mcdem::SurfaceLaw* law = nullptr;
        double curvature = 0;  ///< of a wall around an upright axis, hollow: below zero [1/m]
    };
    /// What two bodies in contact share.
    struct Joint {
        double modulus, shear_modulus;  ///< E*, G* [Pa]
        double radius, mass;            ///< R* [m], m* [kg]
        double damping;                 ///< 2 sqrt(5/6) beta
        double friction;                ///< mu
    };
    Body body(int grain) const;
    Body partner_of(int grain, int partner) const;
    Joint joint(const Body& a, const Body& b) const;
    double poisson_ratio(const Body& body) const;
    std::array<double, 2> friction_and_restitution(const Body& a, const Body& b) const;
    double distance_to(int grain, int partner) const;
    double self_consistent_overlap(double given, const Body& a, const Body& b, const Joint& joint) const;
    double self_compliance(double contact_radius, const Body& body) const;
    double counted_bulges(double geometric, double bulges) const;
    double plastic_overlap(double overlap, double& deepest) const;
    Seen see(int grain, int partner, double elapsed, Memory& memory) const;
    void push(Seen& seen, const Body& a, const Body& b, const Joint& joint, double elapsed,
              Memory& memory) const;
    void attract(Seen& seen, double overlap, const Joint& joint) const;
    Vec3 couple(double normal, const Body& a, const Body& b, const Joint& joint) const;
    Vec3 saturated_friction(double limit, const Vec3& sliding, const Joint& joint) const;
    Vec3 mindlin_friction(double limit, const Vec3& sliding, const Seen& seen, const Joint& joint,
                          double elapsed, Vec3& spring) const;
    void displace_surfaces(const std::vector<std::vector<Seen>>& seen);
    double displacement_energy() const;  ///< [J]

    mcdem::Replica scene_;
    std::vector<mcdem::GrainMaterial> material_;  ///< of each grain
    std::vector<mcdem::SurfaceLaw> law_;          ///< of each grain
    std::vector<double> radius_, youngs_modulus_;
    std::vector<int> species_;
    double time_step_ = 0, reach_ = 0, probe_gap_ = 0;
    double plate_z_ = 0, plate_velocity_ = 0, drag_ = 0, spin_drag_ = 0;
};

}  // namespace reference
