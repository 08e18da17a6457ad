#include "ensemble/plate_pauses.h"

#include <fmt/format.h>

namespace mcdem::inline ensemble {

std::optional<PlatePauses> neglected_pauses(const Replica& replica, const Experiment& experiment,
                                            double max_slowdown) {
    const Protocol& protocol = replica.protocol;
    const double speed = experiment.plate_speed.value_or(0);
    if (!(experiment.plate_pause > 0) || protocol.pause > 0 || !replica.programme.empty())
        return std::nullopt;
    if (!(speed > 0) || speed * max_slowdown < replica.plate.speed) return std::nullopt;
    // Grains that have come to rest do not change during a longer pause.
    const bool rests = protocol.relax_time > 0 && protocol.relax_time < experiment.plate_pause;
    return PlatePauses{rests ? protocol.relax_time : experiment.plate_pause, speed};
}

void apply(Replica& replica, const PlatePauses& pauses) {
    replica.protocol.stop_at_scans = true;
    replica.protocol.pause = pauses.time;
    replica.plate.speed = pauses.speed;
}

NextStep simulate_pauses(const PlatePauses& pauses) {
    return {fmt::format("simulate the pauses of the experiment's plate, during which friction unloads: --set "
                        "protocol.stop_at_scans=true --set protocol.pause={:.3g} --set plate.speed={:.3g}",
                        pauses.time, pauses.speed),
            {}};
}

}  // namespace mcdem::ensemble
