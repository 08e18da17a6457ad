// A programme: the sequence of stages for the plate or a cell.
#pragma once
#include <vector>

#include "core/names.h"
#include "scene/not_given.h"

namespace mcdem::inline core {

enum class StageKind {
    move,    ///< to a position, a strain, a force or stresses
    hold,    ///< position, force or stresses for a time
    cycle,   ///< there and back, several times
    repeat,  ///< earlier stages again
};

/// The controlled quantity.
enum class Controlled { position, force, stress };

template <>
inline constexpr std::array<std::string_view, 4> name_list<StageKind>{"move", "hold", "cycle", "repeat"};
template <>
inline constexpr std::array<std::string_view, 3> name_list<Controlled>{"position", "force", "stress"};

}  // namespace mcdem::core

namespace mcdem::inline scene {

inline constexpr int max_stages = 100;

/// programme_checks.cpp says which members each kind uses.
struct Stage {
    StageKind kind = StageKind::move;
    double position = not_given;  ///< of the plate's lower face [m]
    double strain = not_given;  ///< of the initial height, or of all lengths of a cell; compression positive
    double force = not_given;   ///< upward on the plate [N]
    double strain_x = not_given, strain_y = not_given, strain_z = not_given;  ///< of a cell (core/packing.h)
    double shear_xy = not_given, shear_xz = not_given, shear_yz = not_given;  ///< of a cell
    double pressure = not_given;  ///< of a cell: all three stresses [Pa]
    double stress_x = not_given, stress_y = not_given, stress_z = not_given;     ///< of a cell [Pa]
    double stress_xy = not_given, stress_xz = not_given, stress_yz = not_given;  ///< of a cell [Pa]
    double rate = 0.1;        ///< of a cell: maximum rate of the fastest of its strains [1/s]
    double back = not_given;  ///< point to which a cycle returns, in the quantity of its turning point
    int cycles = 1;
    double growth = 0;  ///< increase of the amplitude from cycle to cycle, over the first one
    Controlled keep = Controlled::position;
    double time = not_given;      ///< of a hold [s]
    int stages = 1;               ///< number of stages before this one that are repeated
    int times = 2;                ///< how often they run in total
    double speed = not_given;     ///< maximum; default: plate.speed [m/s]
    int scans = 1;                ///< equally spaced, for each stroke of a cycle; the last at its end
    std::vector<double> scan_at;  ///< instead of `scans`: values of the stage's quantity, or times of a hold
};

}  // namespace mcdem::scene
