// Parameters of a replica in the format of the kernels, with all constants of the contact law precomputed.
#pragma once
#include <cstdint>
#include <vector>

#include "scene/scene.h"
#include "sim/device_types.h"

namespace mcdem::inline sim {

/// Part of the margin of the neighbour list for the motion of a cell. It is small because strains are slow:
/// grains that collide move much farther within the lifetime of a list.
inline constexpr double cell_share = 0.1;

/// Time step: a fraction of the shortest Rayleigh time of a grain, pi R / rayleigh_speed [s].
double time_step(const Replica& replica, const Packing& packing);

/// The same for a grain with the smallest `radius` and mean stiffness, of the fastest species [s].
double time_step(const Replica& replica, double radius);

/// Shortening of the time step that keeps delayed surface displacements stable when contacts stiffen, for the
/// `step_rate` of a report [1/s]: the number of factors of the eighth root of two. `now` is the current
/// number. It decreases only if steps may be half as long again.
int shortening(double time_step, double step_rate, int now);
double shortened(double time_step, int shortening);
inline constexpr int max_shortening = 40;

/// The container with its width errors.
Box true_box(const Replica& replica);

double mean_radius(const Packing& packing);  ///< [m]

/// Largest distance between centres in a neighbour list [m].
double list_reach(const Replica& replica, const Packing& packing);

/// Position of a replica in the device's arrays.
struct Place {
    int first_grain = 0;
    int grain_count = 0;
    int first_cell = 0;
};

/// DeviceReplica: f32::Replica or f64::Replica. The plate is at rest at its start.
template <class DeviceReplica>
DeviceReplica device_replica(const Replica& replica, const Packing& packing, const Place& place);

/// Sets everything that depends on the time step [s].
template <class DeviceReplica>
void set_time_step(DeviceReplica& device_replica, const Replica& replica, double time_step);

/// Sets the deformation of a cell at the start of the interval and its rate; with `reach` > 0 [m] also the
/// grid for the neighbour search.
template <class DeviceReplica>
void set_strain(DeviceReplica& device_replica, const Replica& replica, const Strain& strain,
                const Strain& strain_rate, double reach);

/// Maximum number of cells of a replica's grid; a grid that would have more is repeated.
constexpr std::uint64_t max_cells(std::uint64_t grains) { return 8 * grains + 64; }

/// Number of cells of a replica's grid.
template <class DeviceReplica>
int cell_count(const DeviceReplica& replica) {
    return replica.cells_x * replica.cells_y * replica.cells_z;
}

}  // namespace mcdem::sim
