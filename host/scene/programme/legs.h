// A programme as a sequence of moves and holds.
#pragma once
#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace mcdem::inline scene {

/// One move of the plate, or one hold.
struct Leg {
    int stage = 0;              ///< index in stages_of()
    double target = not_given;  ///< target of a move: position [m] or force [N]
};

/// The replica's programme; without one, the cycles of [plate] and [protocol] as one stage.
std::vector<Stage> stages_of(const Replica& replica);

/// Expands cycles and repeats.
std::vector<Leg> legs_of(const std::vector<Stage>& stages, const Plate& plate);

/// Sum over all legs of `of_stage(stage)`, the value for one leg of the stage, without creating the legs.
double sum_over_legs(const std::vector<Stage>& stages, const std::function<double(const Stage&)>& of_stage);

/// Number of legs, and of scans in all of them.
double leg_count(const std::vector<Stage>& stages);
double scan_count(const std::vector<Stage>& stages);
inline constexpr double max_legs = 100'000, max_scans = 1'000'000;

/// Throws InputError if a replica is a cell or has species: `what` ("a diagnosis") supports only a plate and
/// grains of one material.
void expect_plate(const Scene& scene, const std::string& what);

/// The same, and if a replica has a programme: `what` supports only strokes.
void expect_plain_strokes(const Scene& scene, const std::string& what);

/// Prescribed stresses of a cell along x, y, z, then xy, xz and yz [Pa]; NaN if the stage does not set one.
using SetStress = std::array<double, 6>;
inline constexpr SetStress no_stress{not_given, not_given, not_given, not_given, not_given, not_given};
inline constexpr std::array<std::string_view, 6> axis_names{"x", "y", "z", "xy", "xz", "yz"};
SetStress set_stress(const Stage& stage);
bool sets_stress(const Stage& stage);

/// The quantity that a move changes or a hold keeps.
Controlled controlled(const Stage& stage);

/// Target of a move, or of cycle number `cycle` (from 0), in the quantity of the stage.
double turning_point(const Stage& stage, int cycle = 0);

/// Converts a value in the quantity of the stage to position [m] or force [N].
double in_si(const Stage& stage, double value, const Plate& plate);

/// Scans in one leg of the stage.
int scans_of(const Stage& stage);
/// Level of scan `number` (from 1) in a move from `from` to `target`: position [m] or force [N].
double scan_level(const Stage& stage, int number, double from, double target, const Plate& plate);
/// Time of scan `number` (from 1) in a hold, since its start [s].
double scan_time(const Stage& stage, int number);

}  // namespace mcdem::scene
