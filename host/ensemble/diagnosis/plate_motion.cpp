#include "ensemble/diagnosis/plate_motion.h"

#include <algorithm>
#include <cmath>

namespace mcdem::inline ensemble {
std::optional<PlateMotion> neglected_motion(const Replica& replica, const Experiment& experiment,
                                            double max_slowdown) {
    const Protocol& protocol = replica.protocol;
    const double speed = experiment.plate_speed.value_or(0);
    if (!(speed > 0) || speed * max_slowdown < replica.plate.speed || !replica.programme.empty())
        return std::nullopt;
    // Grains that have come to rest do not change if the plate stands longer.
    const double rest = protocol.relax_time > 0 ? protocol.relax_time : HUGE_VAL;
    const PlateMotion motion{speed,
                             protocol.pause > 0 ? protocol.pause : std::min(experiment.plate_pause, rest),
                             protocol.hold > 0 ? protocol.hold : std::min(experiment.plate_hold, rest)};
    return changes(replica, motion).empty() ? std::nullopt : std::optional(motion);
}

std::vector<SettingChange> changes(const Replica& replica, const PlateMotion& motion) {
    const Protocol& protocol = replica.protocol;
    std::vector<SettingChange> list;
    const auto add = [&](const char* key, const char* unit, double from, double to) {
        if (from != to) list.push_back({key, unit, from, to});
    };
    add("protocol.pause", "s", protocol.pause, motion.pause);
    add("protocol.hold", "s", protocol.hold, motion.hold);
    add("plate.speed", "m/s", replica.plate.speed, motion.speed);
    add("protocol.rate_tolerance", "", protocol.rate_tolerance, 0);
    return list;
}

void apply(Replica& replica, const PlateMotion& motion) {
    if (motion.pause > 0) replica.protocol.stop_at_scans = true;
    replica.protocol.pause = motion.pause;
    replica.protocol.hold = motion.hold;
    replica.plate.speed = motion.speed;
    replica.protocol.rate_tolerance = 0;
}

}  // namespace mcdem::ensemble
