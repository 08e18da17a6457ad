#include "sim/protocol.h"

#include <algorithm>
#include <cmath>

namespace mcdem {
namespace {

using Stage = ProtocolState::Stage;

/// Stretches in a row below the limit: a packing that passes through rest at the turning point of an
/// oscillation is not taken for one at rest.
constexpr int settled_stretches = 2;

}  // namespace

ProtocolRunner::ProtocolRunner(const Replica& replica, double time_step)
    : plate_(replica.plate), protocol_(replica.protocol), time_step_(time_step) {}

double ProtocolRunner::stroke_begin() const { return state_.phase == Phase::load ? plate_.start : plate_.end; }
double ProtocolRunner::stroke_end() const { return state_.phase == Phase::load ? plate_.end : plate_.start; }

double ProtocolRunner::level_z(int level) const {
    return stroke_begin() + (stroke_end() - stroke_begin()) * level / protocol_.scans_per_stroke;
}

/// Steps from one scan position to the next: the plate's speed is the scene's or a little less.
long ProtocolRunner::move_steps() const {
    const double distance = std::abs(plate_.start - plate_.end) / protocol_.scans_per_stroke;
    return std::max(1L, static_cast<long>(std::ceil(distance / (plate_.speed * time_step_) - 1e-9)));
}

double ProtocolRunner::plate_velocity() const {
    if (state_.stage != Stage::move) return 0;
    return (level_z(state_.level + 1) - level_z(state_.level)) / (move_steps() * time_step_);
}

double ProtocolRunner::plate_z() const {
    switch (state_.stage) {
        case Stage::relax: return plate_.start;
        case Stage::move: {
            const double part = static_cast<double>(state_.stage_step) / move_steps();
            return level_z(state_.level) + (level_z(state_.level + 1) - level_z(state_.level)) * part;
        }
        case Stage::settle: return level_z(state_.level + 1);
        case Stage::finished: break;
    }
    return plate_.start;
}

long ProtocolRunner::steps_left() const {
    if (state_.stage == Stage::move) return move_steps() - state_.stage_step;
    const double most = state_.stage == Stage::relax ? protocol_.relax_time : protocol_.settle_time;
    return std::max(1L, std::lround(most / time_step_) - state_.stage_step);
}

bool ProtocolRunner::settled(const StretchResult& result, bool plate_arrived) {
    const bool still =
        plate_arrived && result.kinetic_energy <= protocol_.settle_kinetic_over_elastic * std::abs(result.elastic_energy);
    state_.settle_stretches = still ? state_.settle_stretches + 1 : 0;
    return state_.settle_stretches >= settled_stretches;
}

void ProtocolRunner::begin(Stage stage) {
    state_.stage = stage;
    state_.stage_step = 0;
    state_.settle_stretches = 0;
}

std::optional<ProtocolRunner::ScanTag> ProtocolRunner::made(const StretchResult& result,
                                                             bool plate_arrived) {
    if (finished()) return std::nullopt;
    state_.step += result.steps;
    state_.stage_step += result.steps;
    if (state_.stage == Stage::move) {
        if (state_.stage_step < move_steps()) return std::nullopt;
        if (!protocol_.stop_at_scans) return arrive(false);
        begin(Stage::settle);
        return std::nullopt;
    }
    const double most = state_.stage == Stage::relax ? protocol_.relax_time : protocol_.settle_time;
    const bool still = settled(result, plate_arrived);
    if (!still && state_.stage_step < std::lround(most / time_step_)) return std::nullopt;
    if (state_.stage == Stage::settle) return arrive(still);
    begin(Stage::move);
    if (!protocol_.scan_at_start) return std::nullopt;
    return ScanTag{state_.frame++, 0, Phase::load, plate_.start, state_.step * time_step_, still};
}

/// The plate is at a scan position: a scan is due, and the next move begins.
std::optional<ProtocolRunner::ScanTag> ProtocolRunner::arrive(bool settled) {
    const ScanTag tag{state_.frame++, state_.cycle, state_.phase, level_z(state_.level + 1),
                      state_.step * time_step_, settled};
    begin(Stage::move);
    if (++state_.level == protocol_.scans_per_stroke) {
        state_.level = 0;
        if (state_.phase == Phase::unload && ++state_.cycle == protocol_.cycles) stop();
        state_.phase = state_.phase == Phase::load ? Phase::unload : Phase::load;
    }
    return tag;
}

double ProtocolRunner::progress() const {
    if (finished()) return 1;
    const double all = 2.0 * protocol_.cycles * protocol_.scans_per_stroke + protocol_.scan_at_start;
    double moved = 0;
    if (state_.stage == Stage::move) moved = static_cast<double>(state_.stage_step) / move_steps();
    if (state_.stage == Stage::settle) moved = 1;
    return (state_.frame + 0.9 * moved) / all;
}

}  // namespace mcdem
