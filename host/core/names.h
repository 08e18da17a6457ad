// Enumerations of scenes and results (contact models, friction laws, containers, walls, phases, sizes) with
// their names. `name` and `parse` use the same table.
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace mcdem::inline core {

/// How a force at one contact of a grain displaces its surface at the others.
enum class ContactModel {
    independent,            ///< Hertz, contacts independent
    point_force_on_sphere,  ///< exact elastic sphere under point forces, no self term
    sphere_to_sphere,       ///< Gonzalez & Cuitino 2012
    elastic_half_space,     ///< paper, Eq. 1 with gamma = 1
    mc_dem,                 ///< paper, Eq. 1 with fitted gamma
    elastic_sphere,         ///< exact elastic sphere with self term and finite contacts; nothing fitted
    hyperelastic_sphere,    ///< elastic sphere and finite strain, by finite elements of one sphere
};

enum class FrictionLaw {
    saturated,  ///< |F_t| = mu F_n against the sliding velocity
    mindlin,    ///< tangential spring, limited to mu F_n, whose force does not grow with the normal load
    mindlin_displacement,  ///< .. whose displacement is kept instead, as in LIGGGHTS
};

/// Boundary at the sides, between floor and plate.
enum class ContainerShape {
    box,       ///< four walls
    cylinder,  ///< one upright wall
    periodic,  ///< no side walls: periodic along x and y
    cell,      ///< no walls, floor or plate: periodic along x, y and z
};

enum class Wall { x_min, x_max, y_min, y_max, floor, plate };
inline constexpr int wall_count = 6;

enum class Phase { load, unload };

/// Distribution of the diameters of a species.
enum class SizeLaw {
    normal,     ///< truncated below and above
    lognormal,  ///< truncated below and above
    single,     ///< all equal
    table,      ///< drawn from the diameters in a file with equal probability
};

/// Measure of the fractions of species.
enum class FractionsBy { number, volume };

enum class Precision { single_precision, double_precision };

/// The names of an enumeration, in the order of its values; other types have none.
template <class Enum>
inline constexpr std::nullptr_t name_list{};
template <>
inline constexpr std::array<std::string_view, 7> name_list<ContactModel>{
    "independent", "point_force_on_sphere", "sphere_to_sphere",   "elastic_half_space",
    "mc_dem",      "elastic_sphere",        "hyperelastic_sphere"};
template <>
inline constexpr std::array<std::string_view, 3> name_list<FrictionLaw>{"saturated", "mindlin",
                                                                        "mindlin_displacement"};
template <>
inline constexpr std::array<std::string_view, 4> name_list<ContainerShape>{"box", "cylinder", "periodic",
                                                                           "cell"};
template <>
inline constexpr std::array<std::string_view, 6> name_list<Wall>{"x_min", "x_max", "y_min",
                                                                 "y_max", "floor", "plate"};
template <>
inline constexpr std::array<std::string_view, 2> name_list<Phase>{"load", "unload"};
template <>
inline constexpr std::array<std::string_view, 4> name_list<SizeLaw>{"normal", "lognormal", "single", "table"};
template <>
inline constexpr std::array<std::string_view, 2> name_list<FractionsBy>{"number", "volume"};
template <>
inline constexpr std::array<std::string_view, 2> name_list<Precision>{"float", "double"};

/// The name of `value` in scenes, files and figures.
template <class Enum>
constexpr std::string_view name(Enum value) {
    return name_list<Enum>[static_cast<std::size_t>(value)];
}

/// The value with the name `word`, if any.
template <class Enum>
std::optional<Enum> parse(std::string_view word) {
    for (std::size_t i = 0; i < name_list<Enum>.size(); ++i)
        if (name_list<Enum>[i] == word) return static_cast<Enum>(i);
    return std::nullopt;
}

/// All names of an enumeration, for messages: "a, b, c".
template <class Enum>
std::string all_names() {
    std::string text;
    for (auto word : name_list<Enum>) text += (text.empty() ? "" : ", ") + std::string(word);
    return text;
}

}  // namespace mcdem::core
