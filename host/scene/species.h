// Grains of several materials and sizes in one packing.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/names.h"
#include "scene/not_given.h"

namespace mcdem::inline scene {

struct Replica;

inline constexpr int max_species = 8;
inline constexpr int max_pairs = 44;  ///< of eight species, and of each with the walls
inline constexpr std::string_view walls_name = "walls";

struct GrainMaterial {
    double youngs_modulus = 23.3e3;  ///< E [Pa]
    double poisson_ratio = 0.5;      ///< nu
    double density = 11.5;           ///< inertial [kg/m3]
    double excess_density = 11.5;    ///< over the fluid, gives the weight [kg/m3]
    double friction = 0.03;          ///< mu, grain on grain
    double restitution = 0.95;       ///< e
    double drag = 0;                 ///< background drag, force = -drag * mass * velocity [1/s]
};

struct Sizes {
    SizeLaw law = SizeLaw::normal;
    double mean = not_given;  ///< of the diameter, before it is cut [m]
    double sd = not_given;    ///< .. likewise [m]
    double min = not_given;   ///< where it is cut [m]
    double max = not_given;
    std::string file;                                       ///< of a table
    std::shared_ptr<const std::vector<double>> table = {};  ///< its diameters, sorted [m]
};

/// Read from a scene, what is not given is filled in from [grains] and [packing] (scene/resolve_species.h).
struct Species {
    std::string name;
    GrainMaterial material{not_given, not_given, not_given, not_given, not_given, not_given, 0};
    double fraction = not_given;  ///< of the grains
    Sizes sizes = {};
};

/// Two species, or a species and the walls, that slide or rebound on each other in a way of their own.
struct SpeciesPair {
    std::string first, second;
    double friction = not_given;
    double restitution = not_given;
};

/// One for each species; that of [grains] where none are named.
std::vector<GrainMaterial> materials(const Replica& replica);

/// Of largest E/(1 - nu^2), and of smallest.
GrainMaterial stiffest(const Replica& replica);
GrainMaterial softest(const Replica& replica);

/// E/(1 - nu^2) [Pa]
constexpr double plane_modulus(const GrainMaterial& material) {
    return material.youngs_modulus / (1 - material.poisson_ratio * material.poisson_ratio);
}

/// mu and e of a contact.
struct PairLaw {
    double friction, restitution;
};
/// Of two species: what their [[pair]] says, else the smaller of both.
PairLaw pair_law(const Replica& replica, std::size_t first, std::size_t second);
/// Of a species and the walls: what their [[pair]] says, else what [walls] says.
PairLaw wall_law(const Replica& replica, std::size_t species);

}  // namespace mcdem::scene
