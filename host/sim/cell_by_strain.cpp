#include "sim/cell_by_strain.h"

#include <fmt/format.h>

#include <algorithm>

namespace mcdem::inline sim {

bool CellByStrain::driven(const RunningProgramme& programme) {
    return programme.stage().kind == StageKind::move && programme.target() > programme.state.leg_begin;
}

ProgrammeMotion::Plan CellByStrain::plan(const RunningProgramme& programme) const {
    const bool moves = programme.state.activity == Activity::move;
    Plan plan = moves ? moving(programme, slow_speed(programme)) : standing(programme);
    deform(programme, plan);
    return plan;
}

void CellByStrain::deform(const RunningProgramme& programme, Plan& plan) const {
    plan.interval.plate_velocity = 0;
    plan.interval.strain = strain(programme);
    plan.interval.strain_rate = programme.cell_move().direction();
    for (double& rate : plan.interval.strain_rate) rate *= plan.speed;
}

void CellByStrain::follow(RunningProgramme& programme, const Plan&, const IntervalResult& result,
                          double duration) const {
    programme.add_pressure(programme.quasi_static.pressure(result.stress));
    CellControl::observe(programme.state.cell, result.stress, duration);
}

Strain CellByStrain::strain(const RunningProgramme& programme) const {
    return with_controlled(programme, programme.cell_move().strain(programme.state.plate_z));
}

void CellByStrain::begin_path(RunningProgramme& programme) {
    if (programme.state.leg == 0) CellControl::begin_leg(programme.state.cell, {});
}

void CellByStrain::begin_leg(RunningProgramme& programme) const {
    begin_path(programme);
    CellControl::rest(programme.state.cell);
    if (programme.is_hold()) return;
    expect_listed_scans(programme);
    if (driven(programme)) programme.set_phase(programme.cell_move().loads());
}

void CellByStrain::end_leg(RunningProgramme& programme) const {
    const CellMove move = programme.cell_move();
    const Strain strain = with_controlled(programme, move.to);
    programme.state.leg_begin = move.end;
    CellControl::begin_leg(programme.state.cell, strain);
}

/// Where a move starts may be known only now.
void CellByStrain::expect_listed_scans(RunningProgramme& programme) {
    if (programme.stage().scan_at.empty()) return;
    const ScanQuantity& quantity = programme.quantity();
    const double begin = programme.quantity_begin(), end = quantity.target;
    for (const double at : programme.stage().scan_at) {
        const double rounding = quantity.of_stress ? min_change * std::abs(at) : 0;
        if (at >= std::min(begin, end) - rounding && at <= std::max(begin, end) + rounding) continue;
        return programme.give_up(fmt::format(
            "there is no scan at {} = {:.6g}: the move goes from {:.6g} to {:.6g} (leave it out of scan_at)",
            quantity_name(programme.stage(), quantity), at, begin, end));
    }
}

}  // namespace mcdem::sim
