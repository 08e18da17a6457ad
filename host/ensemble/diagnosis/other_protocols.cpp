#include "ensemble/diagnosis/other_protocols.h"

#include <fmt/format.h>

namespace mcdem::inline ensemble {
namespace {

/// Relaxation times for which the plate is held.
constexpr double times_held = 3;

/// Factor by which the plate is slower. Simulations take as much longer.
constexpr double times_slower = 4;

double held_for(const Replica& replica) { return times_held * replica.effects.relaxation_time; }

/// One stroke down and up as a programme, with a hold and a scan at its end between them.
void hold(Replica& replica) {
    Stage down, held, up;
    down.position = replica.plate.end;
    up.position = replica.plate.start;
    down.scans = up.scans = replica.protocol.scans_per_stroke;
    held.kind = StageKind::hold;
    held.time = held_for(replica);
    replica.programme = {down, held, up};
    replica.protocol.scan_at_start = true;
}

void slow_down(Replica& replica) {
    replica.plate.speed /= times_slower;
    replica.protocol.rate_tolerance /= times_slower;
}

Grid with_hold(Grid grid, const Replica& replica) {
    const int begin = replica.protocol.scans_per_stroke;  // scan 0 is before the stroke
    grid.holds = {{begin, begin + 1, begin + 1, Controlled::position, Phase::load, grid.stroke}};
    return grid;
}

}  // namespace

std::vector<OtherProtocol> other_protocols(const TrialSettings& common, const Replica& replica, bool slower) {
    if (!replica.programme.empty()) return {};
    TrialSettings held = common;
    held.grid = with_hold(common.grid, replica);
    held.discard = 0;
    std::vector<OtherProtocol> all{
        {fmt::format("hold the plate at full stroke for {:g} s", held_for(replica)), held, hold},
        {"press one more cycle", common, [](Replica& changed) { ++changed.protocol.cycles; }}};
    if (slower) all.push_back({fmt::format("press {:g} times slower", times_slower), common, slow_down});
    return all;
}

}  // namespace mcdem::ensemble
