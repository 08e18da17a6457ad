// A plate that moves to forces and keeps them, between plate.end and plate.start.
#pragma once
#include "sim/plate_by_position.h"

namespace mcdem::inline sim {

class PlateByForce : public PlateByPosition {
public:
    PlateByForce(const Replica& replica, const PackingScale& scale);

    Plan plan(const RunningProgramme& programme) const override;
    void follow(RunningProgramme& programme, const Plan& plan, const IntervalResult& result,
                double duration) const override;
    bool arrived(RunningProgramme& programme) const override;
    bool reached(const RunningProgramme& programme) const override;
    double drag(const RunningProgramme& programme) const override;
    double progress(const RunningProgramme& programme) const override;
    void begin_leg(RunningProgramme& programme) const override;

private:
    long max_steps(const RunningProgramme& programme) const;

    ForceControl control_;
};

}  // namespace mcdem::sim
