// A plate that moves to positions, at a prescribed speed or as slowly as forces must be quasi-static.
#pragma once
#include "sim/motion.h"

namespace mcdem::inline sim {

class PlateByPosition : public ProgrammeMotion {
public:
    Plan plan(const RunningProgramme& programme) const override;
    void follow(RunningProgramme& programme, const Plan& plan, const IntervalResult& result,
                double duration) const override;
    double length(const RunningProgramme& programme) const override { return programme.state.plate_z; }
    void begin_leg(RunningProgramme& programme) const override;

protected:
    double max_speed(const RunningProgramme& programme) const override;
};

}  // namespace mcdem::sim
