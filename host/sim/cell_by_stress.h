// A cell with prescribed stresses: each direction and each shear that has one is controlled, and strains of
// the same move change as fast as the control can follow.
#pragma once
#include "sim/cell_by_strain.h"

namespace mcdem::inline sim {

class CellByStress : public CellByStrain {
public:
    CellByStress(const Replica& replica, const PackingScale& scale) : control_(replica, scale) {}

    Plan plan(const RunningProgramme& programme) const override;
    void follow(RunningProgramme& programme, const Plan& plan, const IntervalResult& result,
                double duration) const override;
    bool arrived(RunningProgramme& programme) const override;
    bool reached(const RunningProgramme& programme) const override;
    double drag(const RunningProgramme& programme) const override;
    double progress(const RunningProgramme& programme) const override;
    void begin_leg(RunningProgramme& programme) const override;

protected:
    Strain with_controlled(const RunningProgramme& programme, const Strain& strain) const override;

private:
    /// The prescribed stresses. With stops they are those of the next scan if only stresses change, otherwise
    /// those at the end of the move.
    SetStress stress(const RunningProgramme& programme) const;
    void give_up(RunningProgramme& programme, std::size_t axis, const std::string& why) const;
    void expect_in_time(RunningProgramme& programme) const;

    CellControl control_;
};

}  // namespace mcdem::sim
