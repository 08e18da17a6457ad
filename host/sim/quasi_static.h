// Speed limit of a quasi-static compression. The relevant number is the inertial number
//     I = (v / H) d sqrt(rho / P),
// the strain rate over the rate at which the pressure P moves a grain of diameter d by its own size (MiDi
// 2004).
#pragma once
#include "core/packing.h"
#include "scene/scene.h"

namespace mcdem::inline sim {

/// Reference quantities of a packing.
struct PackingScale {
    double diameter = 0;  ///< mean [m]
    double weight = 0;    ///< of all grains in the fluid, at least 0 [N]
    std::size_t count = 1;
    double volume = 0;   ///< of all grains [m3]
    double mass = 0;     ///< of all grains [kg]
    double density = 0;  ///< mean density by volume [kg/m3]
    double modulus = 0;  ///< E/(1 - nu^2), mean for layers in series [Pa]
    double reach = 0;    ///< largest distance between centres of possible neighbours [m]
    double top = 0;      ///< highest position at which the plate would touch a grain [m]
};
PackingScale scale_of(const Replica& replica, const Packing& packing);

/// Upper estimate, over the inertial number, of the relative error of forces averaged over packings. Measured
/// with `mcdem converge` on packings of 216 and 514 grains it is four to seven times I. Single packings take
/// other courses at other speeds and differ by more (scenes/README.md, scripts/plate_speed).
inline constexpr double error_per_inertial_number = 10;

class QuasiStatic {
public:
    QuasiStatic(const Replica& replica, const PackingScale& scale);

    /// Pressure between floor and plate, at least the larger of the packing's weight over the floor's area
    /// and a hundred-thousandth of Young's modulus of the softest grains [Pa].
    double pressure(double plate_force, double floor_force) const;
    /// The same for a cell: one third of the trace of its stress.
    double pressure(const Mat3& stress) const;
    /// Estimated relative error of forces at this speed [m/s]; for a cell `speed` is the rate and plate_z is
    /// one.
    double rate_error(double speed, double plate_z, double pressure) const;
    /// Speed of the plate: `max_speed`, or less if protocol.rate_tolerance requires it [m/s].
    double speed(double max_speed, double plate_z, double pressure) const;
    /// Factor by which protocol.rate_tolerance slows a plate of this speed [m/s] while grains rearrange.
    double slowing(double kinetic_energy, double speed) const;
    double min_pressure() const { return min_pressure_; }  ///< lower limit of pressure() [Pa]
    /// Root mean square of the net forces on grains over the pressure on a grain's cross-section, computed
    /// from the kinetic energy. Valid if drag [1/s] dominates: a velocity is then net force / (mass drag).
    double unbalanced_force(double kinetic_energy, double drag, double pressure) const;

private:
    double tolerance_, area_, density_;
    PackingScale scale_;
    double min_pressure_;
};

}  // namespace mcdem::sim
