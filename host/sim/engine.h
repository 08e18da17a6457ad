// Advances a batch of replicas on a device, interval by interval. An interval is a number of steps, each
// replica's own, with the plate at constant velocity; between intervals the host may look and decide.
#pragma once
#include <array>
#include <functional>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "core/recording.h"
#include "scene/scene.h"
#include "sim/device_types.h"
#include "sim/fields.h"

namespace mcdem::inline sim {

/// What a replica is to do next.
struct StepInterval {
    int steps = 0;              ///< 0: nothing, the replica is left as it is
    double plate_z = 0;         ///< when the interval begins [m]
    double plate_velocity = 0;  ///< [m/s]
    double settle_drag = 0;     ///< of velocities, on top of the scene's, and of spins [1/s]
    Strain strain{};            ///< of a cell, when the interval begins
    Strain strain_rate{};       ///< [1/s]
};

/// What became of it.
struct IntervalResult {
    int steps = 0;               ///< made; fewer than asked for where the neighbour list had to be made anew
    double kinetic_energy = 0;   ///< [J]
    double elastic_energy = 0;   ///< [J]
    double deepest_overlap = 0;  ///< corrected overlap over the sum of radii
    double frequency = 0;        ///< upper estimate of the fastest mode's (kernels/measure.cl) [rad/s]
    std::array<Vec3, wall_count> wall_force = no_wall_forces();  ///< on the walls [N]
    Mat3 stress = unknown_tensor();  ///< of a cell, compression positive (core/stress.h) [Pa]
    int status = 0;                  ///< STATUS_* bits
    int failed_grain = -1;           ///< the user's grain number
};

/// A replica as it stands: by the user's grain numbers. In a cell grains are where they have moved to, also
/// out of it, and velocities are those beyond the cell's own motion.
struct ReplicaState {
    std::vector<Vec3> position, velocity, angular_velocity;
    std::vector<Vec3> rotation;  ///< since the start, axis times angle, at most pi [rad]
    std::vector<Contact> contacts;
};

class Engine {
public:
    /// `replicas[r]` starts from `packings[r]` at rest.
    Engine(Device& device, const KernelBuild& build, std::vector<Replica> replicas,
           std::vector<Packing> packings);

    int replicas() const { return layout_.replicas(); }
    /// Of the next interval [s].
    double time_step(int replica) const;
    /// The most steps that the interval may have with its velocity of the plate, or its strain rate, so that
    /// these do not outrun the neighbour list.
    int max_interval(int replica, const StepInterval& interval) const;
    /// How far the plate may move in one interval of more than one step [m].
    double max_plate_move(int replica) const;
    /// Device memory in use [bytes].
    FieldMemory memory() const { return fields_.memory(); }

    /// One interval of every replica; returns when done.
    std::vector<IntervalResult> advance(const std::vector<StepInterval>& intervals);

    /// Positions and contacts as the last interval of `replica` left them.
    ReplicaState state(int replica) const;
    /// Calls use(i, state of replicas[i]) for every i, on all cores and in no order. `replicas` ascend; those
    /// that stand side by side in the batch are read together.
    void for_each_state(const std::vector<int>& replicas,
                        const std::function<void(std::size_t, ReplicaState)>& use) const;
    /// For tests: sets velocities by the user's grain numbers.
    void set_velocities(int replica, const std::vector<Vec3>& velocity,
                        const std::vector<Vec3>& angular_velocity);

    /// Everything that continues the run bit for bit, as named bytes.
    std::map<std::string, std::vector<std::byte>> save();
    /// Throws RunError when `saved` does not belong to this batch.
    void restore(const std::map<std::string, std::vector<std::byte>>& saved);

private:
    /// Some replicas of the batch and the blocks that hold their grains.
    struct Part {
        std::vector<int> replicas, blocks;
        std::vector<Portion> portions;
    };
    /// What states are made of, of replicas side by side: rows of grains and of slots as the device has them.
    struct Readings {
        std::size_t first_grain;
        std::vector<std::byte> motion, tracks, force_x, force_y, force_z, overlap, arm;
        std::vector<int> partner;
    };
    Part part(const std::vector<char>& wanted) const;
    void upload_materials();
    void upload_packings(const std::vector<Packing>& packings);
    double speed_of_walls(int replica, const StepInterval& interval) const;
    void choose(const std::vector<char>& active);
    void upload_intervals(const std::vector<StepInterval>& intervals);
    void find_neighbours(const std::vector<char>& active);
    void make_steps(int steps);
    void measure();
    std::vector<Mat3> read_stresses(const std::vector<Strain>& strain) const;
    std::vector<IntervalResult> read_reports(const std::vector<StepInterval>& intervals);
    IntervalResult result_of(int replica, const double* reals, int status, int failed_place) const;
    template <class Quantity>
    std::vector<std::byte> read_bytes(const Field<Quantity>& field, std::size_t first,
                                      std::size_t count) const;
    template <class Quantity>
    std::vector<double> read_reals(const Field<Quantity>& field, std::size_t first, std::size_t count) const;
    template <class Quantity>
    void write_reals(Field<Quantity>& field, std::size_t first, const std::vector<double>& values);
    std::vector<double> reals(const std::vector<std::byte>& bytes, std::size_t first,
                              std::size_t count) const;
    Readings readings(int first_replica, int last_replica) const;
    ReplicaState state(int replica, const Readings& readings) const;
    std::vector<Contact> contacts(int replica, const std::vector<Vec3>& position,
                                  const Readings& readings) const;

    KernelBuild build_;
    std::vector<Replica> replicas_;
    Layout layout_;
    std::vector<double> time_step_;                       ///< the scene's [s]
    std::vector<int> shortening_;                         ///< of it (device_replica.h)
    std::vector<double> skin_;                            ///< [m]
    std::vector<std::vector<double>> excess_compliance_;  ///< E/E_i - 1 by the user's grain numbers
    std::vector<char> rebuild_;                           ///< 1: the neighbour list is to be made anew
    std::vector<double> reach_;                           ///< of the list, between centres, at most [m]
    std::vector<double> plate_moved_;  ///< since the list was made; or a cell at its ends [m]
    std::vector<double> plate_z_;      ///< where the last interval left it [m]
    std::vector<Strain> strain_;       ///< of a cell, the same
    std::vector<long> steps_made_;
    std::vector<char> active_;  ///< the replicas of working_
    Part working_;              ///< in work, as the device's lists have it
    std::variant<std::vector<f32::Replica>, std::vector<f64::Replica>> device_replicas_;
    Fields fields_;
    Kernels kernels_;
};

/// Throws InputError: `what` a checkpoint holds cannot be.
[[noreturn]] void refuse_checkpoint(const std::string& what);

}  // namespace mcdem::sim
