// How slow a compression has to be. Rate enters through the inertial number
//     I = (v / H) d sqrt(rho / P),
// the strain rate over the rate at which the pressure P moves a grain of diameter d by its own size (MiDi
// 2004).
#pragma once
#include "core/packing.h"
#include "scene/scene.h"

namespace mcdem::inline sim {

/// What the rate of a compression is measured against.
struct PackingScale {
    double diameter = 0;  ///< mean [m]
    double weight = 0;    ///< of all grains in the fluid, at least 0 [N]
    std::size_t count = 1;
    double volume = 0;   ///< of all grains [m3]
    double mass = 0;     ///< of all grains [kg]
    double density = 0;  ///< their mean, by volume [kg/m3]
    double modulus = 0;  ///< E/(1 - nu^2), as of layers one on the other [Pa]
    double reach = 0;    ///< between centres that may be neighbours, at most [m]
};
PackingScale scale_of(const Replica& replica, const Packing& packing);

/// Relative error of forces over the inertial number: an upper estimate. Measured with `mcdem converge` on
/// packings of 216 and 514 grains, the mean error of the top force is four to seven times I
/// (scenes/README.md).
inline constexpr double error_per_inertial_number = 10;

class QuasiStatic {
public:
    QuasiStatic(const Replica& replica, const PackingScale& scale);

    /// Between floor and plate, at least what the packing's weight and a hundred-thousandth of its modulus
    /// make [Pa].
    double pressure(double plate_force, double floor_force) const;
    /// The same of a cell, a third of the trace of its stress.
    double pressure(const Mat3& stress) const;
    /// Estimated relative error of forces at this speed [m/s]; of a cell at this rate, with a plate_z of one.
    double rate_error(double speed, double plate_z, double pressure) const;
    /// The plate's speed: `max_speed`, or less where protocol.rate_tolerance asks for it [m/s].
    double speed(double max_speed, double plate_z, double pressure) const;
    double min_pressure() const { return min_pressure_; }  ///< that pressure() gives [Pa]
    /// Root mean square of the net forces on grains whose motion a drag [1/s] alone resists, over the
    /// pressure on a grain's cross-section: their velocities are then net force / (mass drag).
    double unbalanced_force(double kinetic_energy, double drag, double pressure) const;

private:
    double tolerance_, area_, density_;
    PackingScale scale_;
    double min_pressure_;
};

}  // namespace mcdem::sim
