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
inline constexpr int max_pairs = 44;  ///< between eight species, and of each with the walls
inline constexpr std::string_view walls_name = "walls";

struct GrainMaterial {
    double youngs_modulus = 23.3e3;  ///< E [Pa]
    double poisson_ratio = 0.5;      ///< nu
    double density = 11.5;           ///< inertial [kg/m3]
    double excess_density = 11.5;    ///< density minus that of the fluid; determines the weight [kg/m3]
    double friction = 0.03;          ///< mu between grains
    double restitution = 0.95;       ///< e
    double drag = 0;                 ///< background drag, force = -drag * mass * velocity [1/s]
};

struct Sizes {
    SizeLaw law = SizeLaw::normal;
    double mean = not_given;  ///< of the diameter, before truncation [m]
    double sd = not_given;    ///< of the diameter, before truncation [m]
    double min = not_given;   ///< limits of truncation [m]
    double max = not_given;
    std::string file;                                       ///< of a table
    std::shared_ptr<const std::vector<double>> table = {};  ///< its diameters, sorted [m]
};

/// As read from a scene, with missing values filled in from [grains] and [packing]
/// (scene/read/resolve_species.h).
struct Species {
    std::string name;
    GrainMaterial material{not_given, not_given, not_given, not_given, not_given, not_given, 0};
    double fraction = not_given;  ///< of the grains
    Sizes sizes = {};
};

/// Friction and restitution between two species, or a species and the walls.
struct SpeciesPair {
    std::string first, second;
    double friction = not_given;
    double restitution = not_given;
};

/// One material per species; that of [grains] if there are no species.
std::vector<GrainMaterial> materials(const Replica& replica);

/// The materials with the largest and the smallest E/(1 - nu^2).
GrainMaterial stiffest(const Replica& replica);
GrainMaterial softest(const Replica& replica);

/// E/(1 - nu^2) [Pa]
constexpr double plane_modulus(const GrainMaterial& material) {
    return material.youngs_modulus / (1 - material.poisson_ratio * material.poisson_ratio);
}

/// Speed of Rayleigh waves, sqrt(G / rho) (0.163 nu + 0.8766) [m/s].
double rayleigh_speed(const GrainMaterial& material);

/// The shortest time in which such a wave crosses half the circumference of a grain of this radius [m],
/// pi R / rayleigh_speed, of all materials [s].
double rayleigh_time(const Replica& replica, double radius);

/// mu and e of a contact.
struct PairLaw {
    double friction, restitution;
};
/// Law between two species: from their [[pair]], otherwise the smaller of both values.
PairLaw pair_law(const Replica& replica, std::size_t first, std::size_t second);
/// Law between a species and the walls: from their [[pair]], otherwise from [walls].
PairLaw wall_law(const Replica& replica, std::size_t species);

}  // namespace mcdem::scene
