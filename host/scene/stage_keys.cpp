// The keys of a programme's stages: the same rows for every stage.
#include "scene/key_rows.h"
#include "scene/list_tables.h"

namespace mcdem::inline scene {
namespace {

using namespace rows;

template <auto member>
auto& of_stage(Settings& settings, std::size_t n) {
    return element(settings.replica.programme, n).*member;
}

constexpr Range compression{-10, 0.99, Range::Low::included}, shear{-5, 5, Range::Low::included},
    shear_stress{-1e13, 1e13, Range::Low::included};

// clang-format off
const Key stage_rows[] = {
    {"stage", of_stage<&Stage::kind>, "", none, one_run, "move: to a position, strain or force; hold: keep one for a time; cycle: move there and back; repeat: earlier stages. A cell moves to strains and stresses, holds and repeats"},
    {"position", of_stage<&Stage::position>, "m", above_zero_to(1000), each, "target of a move, or turning point of a cycle: position of the plate's lower face, from plate.end to plate.start"},
    {"strain", of_stage<&Stage::strain>, "", {0, 1, Range::Low::included}, each, "the same as a strain of the initial height: plate.start (1 - strain); cell: equal strain of its three lengths"},
    {"force", of_stage<&Stage::force>, "N", above_zero_to(1e9), each, "the same as a force on the plate, reached within 0.1 % from the side from which the plate comes"},
    {"strain_x", of_stage<&Stage::strain_x>, "", compression, each, "cell: target of a move, as a compression relative to the initial length; strains that a move does not name do not change"},
    {"strain_y", of_stage<&Stage::strain_y>, "", compression, each, "along y"},
    {"strain_z", of_stage<&Stage::strain_z>, "", compression, each, "along z"},
    {"shear_xy", of_stage<&Stage::shear_xy>, "", shear, each, "cell: displacement of planes y = const. along x, over their initial distance"},
    {"shear_xz", of_stage<&Stage::shear_xz>, "", shear, each, "planes z = const. along x"},
    {"shear_yz", of_stage<&Stage::shear_yz>, "", shear, each, "planes z = const. along y"},
    {"pressure", of_stage<&Stage::pressure>, "Pa", above_zero_to(1e13), each, "cell: target of a move, the same stress along x, y and z, reached within 0.1 %; compression positive"},
    {"stress_x", of_stage<&Stage::stress_x>, "Pa", above_zero_to(1e13), each, "cell: target stress along x, instead of a strain along x; strains of the same move wait until it is reached, and it is kept while they change"},
    {"stress_y", of_stage<&Stage::stress_y>, "Pa", above_zero_to(1e13), each, "along y"},
    {"stress_z", of_stage<&Stage::stress_z>, "Pa", above_zero_to(1e13), each, "along z"},
    {"stress_xy", of_stage<&Stage::stress_xy>, "Pa", shear_stress, each, "cell: target shear stress, instead of shear_xy, reached within 0.1 %; a positive shear needs a negative shear stress. It waits until the stresses of the same move along x, y and z are reached"},
    {"stress_xz", of_stage<&Stage::stress_xz>, "Pa", shear_stress, each, "instead of shear_xz"},
    {"stress_yz", of_stage<&Stage::stress_yz>, "Pa", shear_stress, each, "instead of shear_yz"},
    {"back", of_stage<&Stage::back>, "", {0, 1e9, Range::Low::included}, each, "point to which a cycle returns, in the same quantity (position, strain or force) as its turning point"},
    {"cycles", of_stage<&Stage::cycles>, "", {1, 10000}, each, "cycle: number of cycles"},
    {"growth", of_stage<&Stage::growth>, "", {-1, 1000, Range::Low::excluded}, each, "cycle: increase of the amplitude from one cycle to the next, over the first amplitude"},
    {"keep", of_stage<&Stage::keep>, "", none, one_run, "hold: what is kept constant: the plate's position or force; for a cell its strains (position), or the stresses that the previous move set (stress). The other quantity is recorded against time"},
    {"time", of_stage<&Stage::time>, "s", above_zero_to(1e6), each, "hold: duration"},
    {"stages", of_stage<&Stage::stages>, "", {1, max_stages}, one_run, "repeat: number of stages before it that are repeated"},
    {"times", of_stage<&Stage::times>, "", {2, 10000}, each, "repeat: how often they run in total"},
    {"speed", of_stage<&Stage::speed>, "m/s", above_zero_to(1000), each, "maximum speed of the plate; default: plate.speed. protocol.rate_tolerance may reduce it"},
    {"rate", of_stage<&Stage::rate>, "1/s", above_zero_to(100), each, "cell: maximum rate of the fastest of its strains and shears. protocol.rate_tolerance may reduce it"},
    {"scans", of_stage<&Stage::scans>, "", {0, 10000}, each, "number of scans, equally spaced, the last at the end. Move, and each stroke of a cycle: spaced in position, strain or force (in stress if a move of a cell sets only stresses); hold: spaced in time"},
    {"scan_at", of_stage<&Stage::scan_at>, "", none, one_run, "instead of scans: a list of positions, strains or forces (the quantity of the move), or of times since the start of a hold. Move of a cell: of the strain, shear or, if it sets only stresses, stress that changes most (see Programmes)"},
};
// clang-format on

}  // namespace

std::span<const Key> stage_keys(int stage) {
    static const ListKeys all("programme", max_stages, stage_rows);
    return all.of(stage);
}

}  // namespace mcdem::scene
