// A programme as the moves and holds that it consists of, one after the other.
#pragma once
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace mcdem::inline scene {

/// One way of the plate, or one hold.
struct Leg {
    int stage = 0;              ///< of stages_of()
    double target = not_given;  ///< of a move: position [m] or force [N]
};

/// The replica's programme; where it has none, the cycles of [plate] and [protocol] as one stage.
std::vector<Stage> stages_of(const Replica& replica);

/// Cycles and repeats written out.
std::vector<Leg> legs_of(const std::vector<Stage>& stages, const Plate& plate);

/// The sum of a number over all legs, without making them; `of_stage(stage)` is that of one leg of the stage.
double sum_over_legs(const std::vector<Stage>& stages, const std::function<double(const Stage&)>& of_stage);

/// How many legs there are, and scans on all of them.
double leg_count(const std::vector<Stage>& stages);
double scan_count(const std::vector<Stage>& stages);
inline constexpr double max_legs = 100'000, max_scans = 1'000'000;

/// Throws InputError where a replica is a cell or has species: `what` ("a diagnosis") knows a plate on grains
/// of one material only.
void expect_plate(const Scene& scene, const std::string& what);

/// The same, and where a replica has a programme: `what` knows strokes only.
void expect_plain_strokes(const Scene& scene, const std::string& what);

/// Of a cell's directions x, y and z [Pa]; not-a-number where a stage does not set a stress.
using SetStress = std::array<double, 3>;
inline constexpr SetStress no_stress{not_given, not_given, not_given};
SetStress set_stress(const Stage& stage);
bool sets_stress(const Stage& stage);

/// What a move ends at, or a hold keeps.
Controlled controlled(const Stage& stage);

/// Where a move ends, or a cycle turns round (from 0), in the stage's quantity.
double turning_point(const Stage& stage, int cycle = 0);

/// A value in the stage's quantity as position [m] or force [N].
double in_si(const Stage& stage, double value, const Plate& plate);

/// Of one leg of the stage.
int scans_of(const Stage& stage);
/// Where scan `number`, from 1, of a move from `from` to `target` is taken: position [m] or force [N].
double scan_level(const Stage& stage, int number, double from, double target, const Plate& plate);
/// When scan `number`, from 1, of a hold is taken, since the hold's beginning [s].
double scan_time(const Stage& stage, int number);

}  // namespace mcdem::scene
