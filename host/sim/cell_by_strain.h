// A cell that moves along its strain path at a prescribed rate, or as slowly as stresses must be
// quasi-static.
#pragma once
#include "sim/motion.h"

namespace mcdem::inline sim {

class CellByStrain : public ProgrammeMotion {
public:
    Plan plan(const RunningProgramme& programme) const override;
    void follow(RunningProgramme& programme, const Plan& plan, const IntervalResult& result,
                double duration) const override;
    double length(const RunningProgramme&) const override { return 1; }
    Strain strain(const RunningProgramme& programme) const override;
    void begin_leg(RunningProgramme& programme) const override;
    void end_leg(RunningProgramme& programme) const override;

protected:
    double max_speed(const RunningProgramme& programme) const override { return programme.last_move().rate; }
    /// These strains, with the current ones of directions that have a prescribed stress.
    virtual Strain with_controlled(const RunningProgramme&, const Strain& strain) const { return strain; }
    /// The strain path and its changes of stress start with the first leg.
    static void begin_path(RunningProgramme& programme);
    /// Whether the move changes strains.
    static bool driven(const RunningProgramme& programme);
    /// Replaces the plate's velocity by strains and their rates.
    void deform(const RunningProgramme& programme, Plan& plan) const;
    /// Ends the programme if a scan of its list is outside the move.
    static void expect_listed_scans(RunningProgramme& programme);
    /// A move with a smaller relative change of stresses is treated as keeping them.
    static constexpr double min_change = 1e-3;
};

}  // namespace mcdem::sim
