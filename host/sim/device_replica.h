// A replica's parameters in the form the kernels read: every constant of the contact law worked out once.
#pragma once
#include <cstdint>
#include <vector>

#include "scene/scene.h"
#include "sim/device_types.h"

namespace mcdem::inline sim {

/// Fraction of the shortest Rayleigh time of a grain, pi R / rayleigh_speed [s].
double time_step(const Replica& replica, const Packing& packing);

/// The same of a grain of the smallest `radius` and mean stiffness, of whatever species is fastest [s].
double time_step(const Replica& replica, double radius);

/// The same shortened to what delayed surface displacements stand where contacts have stiffened, for the
/// frequency of a report [rad/s]: as a number of times by which it is shortened by the eighth root of two.
/// Goes back to longer steps only where they may be half as long again.
int shortening(const Replica& replica, double time_step, double frequency, int now);
double shortened(double time_step, int shortening);
inline constexpr int max_shortening = 40;

/// How far centres may be apart in a neighbour list, at most [m].
double list_reach(const Replica& replica, const Packing& packing);

/// How much of the friction force is that of a Mindlin spring, the rest being saturated.
double mindlin_share(const Replica& replica);

/// Where a replica lies in the device's arrays.
struct Place {
    int first_grain = 0;
    int grain_count = 0;
    int first_cell = 0;
};

/// DeviceReplica: f32::Replica or f64::Replica. The plate stands still at its start.
template <class DeviceReplica>
DeviceReplica device_replica(const Replica& replica, const Packing& packing, const Place& place);

/// Everything of the replica that depends on its time step [s].
template <class DeviceReplica>
void set_time_step(DeviceReplica& device_replica, const Replica& replica, double time_step);

/// The deformation of a cell at the interval's start and its rate; with `reach` > 0 [m] the grid to find
/// neighbours by as well.
template <class DeviceReplica>
void set_strain(DeviceReplica& device_replica, const Replica& replica, const Strain& strain,
                const Strain& strain_rate, double reach);

/// Cells of a replica's grid at most: a grid that would have more repeats itself.
constexpr std::uint64_t max_cells(std::uint64_t grains) { return 8 * grains + 64; }

/// Cells of one replica's grid.
template <class DeviceReplica>
int cell_count(const DeviceReplica& replica) {
    return replica.cells_x * replica.cells_y * replica.cells_z;
}

}  // namespace mcdem::sim
