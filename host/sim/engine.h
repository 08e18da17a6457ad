// Advances a batch of replicas on a device, interval by interval. In an interval each replica makes its own
// number of steps with the plate at constant velocity; between intervals the host can read the state and
// decide.
#pragma once
#include <array>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/recording.h"
#include "scene/scene.h"
#include "sim/device_types.h"
#include "sim/fields.h"
#include "sim/layout.h"

namespace mcdem::inline sim {

/// Next interval of a replica.
struct StepInterval {
    int steps = 0;              ///< 0: the replica is not changed
    double plate_z = 0;         ///< at the start of the interval [m]
    double plate_velocity = 0;  ///< [m/s]
    double settle_drag = 0;     ///< drag on velocities in addition to the scene's, and on spins [1/s]
    Strain strain{};            ///< of a cell, at the start of the interval
    Strain strain_rate{};       ///< [1/s]
    double step_part = 1;  ///< of the replica's time step, at most 1: shorter steps for a prescribed speed
};

inline StepInterval in_part(StepInterval interval, double step_part) {
    interval.step_part = step_part;
    return interval;
}

/// Maximum number of steps of an interval.
inline constexpr int max_interval_steps = 60;

/// Result of an interval.
struct IntervalResult {
    int steps = 0;              ///< steps made; fewer than requested if the neighbour list had to be rebuilt
    double kinetic_energy = 0;  ///< [J]
    double elastic_energy = 0;  ///< of contacts, surfaces and springs [J]
    double spring_energy = 0;   ///< of the springs of friction and rolling resistance [J]
    double weight_work = 0;     ///< by the weight, in this interval like all below [J]
    double work = 0;            ///< by the plate or by the motion of a cell [J]
    double damped = 0;          ///< dissipated by normal damping [J]
    double rubbed = 0;   ///< work of tangential forces and couples, dissipated or stored in springs [J]
    double dragged = 0;  ///< dissipated by drag [J]
    double deepest_overlap = 0;  ///< relative corrected overlap (core/law_range.h)
    double step_rate = 0;        ///< inverse of the longest stable time step (kernels/stable_step.h) [1/s]
    std::array<Vec3, wall_count> wall_force = no_wall_forces();  ///< on the walls [N]
    Mat3 stress = unknown_tensor();  ///< of a cell, compression positive (core/stress.h) [Pa]
    int status = 0;                  ///< STATUS_* bits
    int failed_grain = -1;           ///< the user's grain number
};

/// State of a replica, in order of the user's grain numbers. In a cell positions are not wrapped, and
/// velocities are those beyond the cell's own motion.
struct ReplicaState {
    std::vector<Vec3> position, velocity, angular_velocity;
    std::vector<Vec3> rotation;  ///< since the start, axis times angle, at most pi [rad]
    std::vector<Contact> contacts;
};

/// Motion of the grains of a replica at one time, in order of the user's grain numbers.
struct GrainMotion {
    std::vector<Vec3> position, velocity, angular_velocity;  ///< [m], [m/s], [1/s]
};

/// Sum of the contact forces on each grain, and their torque about its centre.
struct GrainForces {
    std::vector<Vec3> force, torque;  ///< [N], [N m]
    double deepest_overlap = 0;       ///< corrected overlap over the sum of radii
    int status = 0;                   ///< STATUS_* bits of the contacts
};

/// Raw data of adjacent replicas from which states are computed: rows of grains and of slots in the device's
/// order. The device copies them while the host goes on.
struct Readings {
    int first_replica = 0, last_replica = 0;
    std::size_t first_grain = 0;
    std::vector<std::byte> motion, tracks, force, overlap, arm, partner;
    PendingCopies copies;  ///< into the vectors above; declared last, so it is waited for before they end
};

/// If the active replicas have this many times the grains of the largest one, the device makes all steps of
/// one replica after another: on a CPU two per core; never on a GPU, which needs all grains at once.
std::size_t enough_replicas(const DeviceInfo& device, const KernelBuild& build);

class Engine {
public:
    /// `replicas[r]` starts from `packings[r]`, with its velocities.
    Engine(Device& device, const KernelBuild& build, std::vector<Replica> replicas,
           std::vector<Packing> packings);

    int replicas() const { return layout_.replicas(); }
    /// Time step of the next interval [s].
    double time_step(int replica) const;
    /// Time step of this interval [s].
    double time_step(int replica, const StepInterval& interval) const {
        return interval.step_part * time_step(replica);
    }
    /// Maximum number of steps of the interval for its plate velocity or strain rate, so that the neighbour
    /// list remains valid.
    int max_interval(int replica, const StepInterval& interval) const;
    /// Shortens the time step of the next intervals by a factor of the square root of two, beyond what the
    /// reports require. Returns false if it is as short as possible.
    bool shorten(int replica);
    /// Maximum displacement of the plate in an interval of more than one step [m].
    double max_plate_move(int replica) const;
    /// Device memory in use [bytes].
    FieldMemory memory() const { return fields_.memory(); }

    /// Starts one interval of every replica on the device. Call finish_interval() next.
    void begin_interval(const std::vector<StepInterval>& intervals);
    /// Returns when the interval is done.
    std::vector<IntervalResult> finish_interval();
    std::vector<IntervalResult> advance(const std::vector<StepInterval>& intervals) {
        begin_interval(intervals);
        return finish_interval();
    }

    /// Starts to copy the states after the last interval from the device. `replicas` must be ascending;
    /// adjacent replicas are read together. Returns the number of readings, the first of `read`, whose memory
    /// is used again.
    std::size_t begin_reading(const std::vector<int>& replicas, std::vector<Readings>& read) const;
    /// Calls `use` for every replica of those read, the i-th of all, on all cores and in any order. It may
    /// call take_state(). Another interval may have begun, but not finished, since the reading began.
    void for_each_state(
        std::span<const Readings> read,
        const std::function<void(std::size_t i, int replica, const Readings& read)>& use) const;
    /// Replaces positions, rotations and contacts of `scan`; their memory is used again.
    void take_state(int replica, const Readings& read, Scan& scan) const;
    /// Positions and contacts after the last interval of `replica`.
    ReplicaState state(int replica) const;
    Precision precision() const { return build_.precision; }
    /// For tests: the time step of the replica is not shortened from now on.
    void keep_time_step(int replica) { run(replica).keeps_step = true; }
    /// For tests: sets velocities by the user's grain numbers.
    void set_velocities(int replica, const std::vector<Vec3>& velocity,
                        const std::vector<Vec3>& angular_velocity);

    /// Contact forces of a replica whose grains move as prescribed, with the plate at rest at its start. The
    /// contacts' memory advances by one time step of length `duration` [s], in which the grains have the
    /// velocities of `motion`; with 0 it does not advance.
    GrainForces forces_at(int replica, const GrainMotion& motion, double duration);

    /// Everything that is needed to continue the run bit for bit, as named byte arrays.
    std::map<std::string, std::vector<std::byte>> save();
    /// Throws RunError if `saved` does not belong to this batch.
    void restore(const std::map<std::string, std::vector<std::byte>>& saved);

private:
    /// What the host keeps of a replica besides its scene.
    struct ReplicaRun {
        double time_step;         ///< of the scene [s]
        double skin;              ///< margin of the neighbour list [m]
        double reach;             ///< largest distance between centres in the list [m]
        bool keeps_step = false;  ///< by keep_time_step()
        bool active = false;      ///< in `working_`
        double plate_z = 0;       ///< at the end of the last interval [m]
        // In checkpoints:
        char rebuild = 1;        ///< 1: the neighbour list must be rebuilt
        double plate_moved = 0;  ///< since the list was built; for a cell, at its ends [m]
        Strain strain{};         ///< of a cell, at the end of the last interval
        long steps_made = 0;
        int shortening = 0;        ///< of the time step (device_replica.h)
        int extra_shortening = 0;  ///< of it, by shorten()
        double weight_work = 0;    ///< of the weight since the list was built [J]
        /// Calls visit(name, member) for each value of a replica that a checkpoint contains.
        template <class Visit>
        static void visit_saved(Visit visit) {
            visit("rebuild", &ReplicaRun::rebuild);
            visit("plate_moved", &ReplicaRun::plate_moved);
            visit("strain", &ReplicaRun::strain);
            visit("steps_made", &ReplicaRun::steps_made);
            visit("shortening", &ReplicaRun::shortening);
            visit("extra_shortening", &ReplicaRun::extra_shortening);
            visit("weight_work", &ReplicaRun::weight_work);
        }
    };

    /// Some replicas, and the blocks and portions of their grains.
    struct Selection {
        std::vector<int> replicas;
        std::vector<Block> blocks;
        std::vector<Portion> portions;
    };
    template <class Wanted>
    Selection select(Wanted wanted) const;
    void upload_materials();
    void upload_packings(const std::vector<Packing>& packings);
    void start_springs(const std::vector<Packing>& packings);
    void write_springs(int replica, const std::vector<TangentialForce>& tangential);
    ReplicaRun& run(int replica) { return runs_[static_cast<std::size_t>(replica)]; }
    const ReplicaRun& run(int replica) const { return runs_[static_cast<std::size_t>(replica)]; }
    double speed_of_walls(int replica, const StepInterval& interval) const;
    bool activate_moving();
    void upload_intervals();
    void find_neighbours();
    void make_steps();
    void measure();
    std::vector<Mat3> read_stresses() const;
    void record(int replica, IntervalResult& result, double moved_squared);
    template <class Quantity>
    std::vector<double> read_reals(const Field<Quantity>& field, std::size_t first, std::size_t count) const;
    template <class Quantity>
    void write_reals(Field<Quantity>& field, std::size_t first, const std::vector<double>& values);
    std::size_t size_of_real() const {
        return build_.precision == Precision::double_precision ? sizeof(double) : sizeof(float);
    }
    std::vector<double> reals(const std::vector<std::byte>& bytes, std::size_t first,
                              std::size_t count) const;
    void begin_reading(int first_replica, int last_replica, Readings& read) const;
    template <class Real>
    void take_state_of(int replica, const Readings& read, Scan& scan) const;
    template <class Real>
    void take_contacts(int replica, const Readings& read, Scan& scan) const;
    GrainForces forces(int replica, const std::vector<Vec3>& position) const;
    void write_motion(int replica, const GrainMotion& motion);
    Vec3 direction(int replica, const Box& box, const std::vector<Vec3>& position, int grain,
                   int partner) const;

    KernelBuild build_;
    std::size_t enough_replicas_;  ///< see enough_replicas()
    std::vector<Replica> replicas_;
    Layout layout_;
    std::vector<ReplicaRun> runs_;
    Selection working_;                    ///< the active replicas, as uploaded to the device
    std::vector<StepInterval> intervals_;  ///< the last ones that were begun
    std::variant<std::vector<f32::Replica>, std::vector<f64::Replica>> device_replicas_;
    Fields fields_;
    Kernels kernels_;
};

/// Throws InputError: the value `what` in a checkpoint is invalid.
[[noreturn]] void refuse_checkpoint(const std::string& what);

}  // namespace mcdem::sim
