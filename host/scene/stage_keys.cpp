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

constexpr Range compression{-10, 0.99, Range::Low::included}, shear{-5, 5, Range::Low::included};

// clang-format off
const Key stage_rows[] = {
    {"stage", of_stage<&Stage::kind>, "", none, one_run, "what the plate does: move to a position, strain or force; hold one for a time; cycle there and back; repeat stages before. A cell moves to strains and stresses, holds and repeats"},
    {"position", of_stage<&Stage::position>, "m", above_zero_to(1000), each, "of a move, or the turning point of a cycle: the plate's lower face, from plate.end to plate.start"},
    {"strain", of_stage<&Stage::strain>, "", {0, 1, Range::Low::included}, each, "the same as a strain of the height at start: plate.start (1 - strain); of a cell: of its three lengths alike"},
    {"force", of_stage<&Stage::force>, "N", above_zero_to(1e9), each, "the same as a force on the plate, reached within 0.1 % from the side that the plate comes from"},
    {"strain_x", of_stage<&Stage::strain_x>, "", compression, each, "of a cell: where a move ends, as a compression of its length at start; what a move does not name stays as it was"},
    {"strain_y", of_stage<&Stage::strain_y>, "", compression, each, "along y"},
    {"strain_z", of_stage<&Stage::strain_z>, "", compression, each, "along z"},
    {"shear_xy", of_stage<&Stage::shear_xy>, "", shear, each, "of a cell: how far planes y = const. move along x, over their distance at start"},
    {"shear_xz", of_stage<&Stage::shear_xz>, "", shear, each, "planes z = const. along x"},
    {"shear_yz", of_stage<&Stage::shear_yz>, "", shear, each, "planes z = const. along y"},
    {"pressure", of_stage<&Stage::pressure>, "Pa", above_zero_to(1e13), each, "of a cell: the stress along x, y and z alike where a move ends, reached within 0.1 %; compression positive"},
    {"stress_x", of_stage<&Stage::stress_x>, "Pa", above_zero_to(1e13), each, "of a cell: the stress along x, in place of a strain there; strains of the same move wait for it, and it is kept on their way"},
    {"stress_y", of_stage<&Stage::stress_y>, "Pa", above_zero_to(1e13), each, "along y"},
    {"stress_z", of_stage<&Stage::stress_z>, "Pa", above_zero_to(1e13), each, "along z"},
    {"back", of_stage<&Stage::back>, "", {0, 1e9, Range::Low::included}, each, "where a cycle returns to, in the quantity (position, strain or force) of its turning point"},
    {"cycles", of_stage<&Stage::cycles>, "", {1, 10000}, each, "of a cycle: how many"},
    {"growth", of_stage<&Stage::growth>, "", {-1, 1000, Range::Low::excluded}, each, "of a cycle: amplitude that each adds to the one before, over the first amplitude"},
    {"keep", of_stage<&Stage::keep>, "", none, one_run, "of a hold: what stays as the stage before left it: the plate's position or force; a cell's strains (position), or the stresses that the move before set (stress). The other is recorded against time"},
    {"time", of_stage<&Stage::time>, "s", above_zero_to(1e6), each, "of a hold: how long"},
    {"stages", of_stage<&Stage::stages>, "", {1, max_stages}, one_run, "of a repeat: how many stages before it"},
    {"times", of_stage<&Stage::times>, "", {2, 10000}, each, "of a repeat: how often they run in all"},
    {"speed", of_stage<&Stage::speed>, "m/s", above_zero_to(1000), each, "of the plate, at most; without it plate.speed. protocol.rate_tolerance may ask for less"},
    {"rate", of_stage<&Stage::rate>, "1/s", above_zero_to(100), each, "of a cell: the fastest of its strains and shears, at most. protocol.rate_tolerance may ask for less"},
    {"scans", of_stage<&Stage::scans>, "", {0, 10000}, each, "equally spaced, the last at the end: in position, strain or force of a move and of each stroke of a cycle, in stress where a move of a cell sets nothing else, in time of a hold"},
    {"scan_at", of_stage<&Stage::scan_at>, "", none, one_run, "in place of scans: a list of positions, strains, forces (as the move has) or times since a hold began"},
};
// clang-format on

}  // namespace

std::span<const Key> stage_keys(int stage) {
    static const ListKeys all("programme", max_stages, stage_rows);
    return all.of(stage);
}

}  // namespace mcdem::scene
