// The device memory of a batch, one field a quantity, and the kernels that work on it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "cl/kernel.h"
#include "cl/program.h"
#include "sim/layout.h"

namespace mcdem {

// Quantities: names only.
struct Constants;
struct Blocks;
struct ReplicaOfBlock;
struct Chosen;
struct StopAt;
struct Position;
struct Velocity;
struct AngularVelocity;
struct Partner;
struct Mirror;
struct Bulge;
struct BulgeHistory;
struct SpringX;
struct SpringY;
struct SpringZ;
struct Deepest;
struct Relaxed;
struct ListedPosition;
struct Status;
struct CellHead;
struct CellNext;
struct ForceX;
struct ForceY;
struct ForceZ;
struct Overlap;
struct Arm;
struct Energy;
struct Reports;

/// Two copies of what neighbours read while a step writes: `now` and `next` change places every step.
template <class Quantity>
struct Pair {
    Field<Quantity> copies[2];
    const Field<Quantity>& now(int parity) const { return copies[parity]; }
    const Field<Quantity>& next(int parity) const { return copies[1 - parity]; }
};

/// Which of the optional fields a batch needs.
struct FieldNeeds {
    bool bulges = false;   ///< some replica has interacting contacts
    bool springs = false;  ///< some replica has friction with history
    bool deepest = false;  ///< some replica has plasticity
    bool relaxed = false;  ///< some replica has viscoelasticity
};

/// How many there are of what fields have one value of, in a batch.
struct FieldExtents {
    std::uint64_t replicas = 0, blocks = 0, grains = 0, cells = 0;  ///< grains: padded
    std::uint64_t slots = 0;                                        ///< of one grain
    Precision precision = Precision::single_precision;
    FieldNeeds needs;
};

/// Device memory of a batch [bytes].
struct FieldMemory {
    std::uint64_t all = 0, largest_field = 0;
};

/// Fields of a grain (padded, all replicas) unless another extent is named.
struct Fields {
    Fields(Device& device, const FieldExtents& extents, const Layout& layout);

    /// What fields of these extents will take, without a device.
    static FieldMemory memory_of(const FieldExtents& extents);

    Field<Constants> replicas;               ///< a replica
    Field<StopAt> stop_at;                  ///< a replica: steps it makes in this stretch
    Field<Reports> reports;                 ///< a replica
    Field<Chosen> chosen, relisted;         ///< replicas in work
    Field<Blocks> blocks, relisted_blocks;  ///< blocks in work
    Field<ReplicaOfBlock> replica_of_block;
    Pair<Position> position;                ///< x y z radius
    Pair<Velocity> velocity;
    Pair<AngularVelocity> angular_velocity;
    Field<ListedPosition> listed_position;
    Field<Status> status;
    Field<Energy> energy;
    Field<Partner> partner;                 ///< a slot, as all below
    Field<Mirror> mirror;                   ///< into bulge; slot_count where there is none
    Pair<Bulge> bulge;                      ///< and one more, always zero, at slot_count
    Field<BulgeHistory> bulge_history;      ///< a slot, for each of the last four steps
    Field<SpringX> spring_x;
    Field<SpringY> spring_y;
    Field<SpringZ> spring_z;
    Field<Deepest> deepest;                 ///< overlap
    Field<Relaxed> relaxed;                 ///< force
    Field<ForceX> force_x;
    Field<ForceY> force_y;
    Field<ForceZ> force_z;
    Field<Overlap> overlap;
    Field<Arm> arm;
    Field<CellHead> cell_head;              ///< a cell
    Field<CellNext> cell_next;

    /// Calls visit(name, field) for every field that a restart must bring back.
    template <class Visit>
    void visit_state(Visit visit) {
        visit("position", position.copies[0]);
        visit("velocity", velocity.copies[0]);
        visit("angular_velocity", angular_velocity.copies[0]);
        visit("listed_position", listed_position);
        visit("status", status);
        visit("partner", partner);
        visit("mirror", mirror);
        visit("bulge", bulge.copies[0]);
        visit("bulge_history", bulge_history);
        visit("spring_x", spring_x);
        visit("spring_y", spring_y);
        visit("spring_z", spring_z);
        visit("deepest", deepest);
        visit("relaxed", relaxed);
    }
    FieldMemory memory() const { return memory_; }
    /// Some replica's surfaces move; else no mirror is ever looked up.
    bool has_bulges() const { return slot_count > 1; }
    int slot_count = 0;  ///< of all grains that have surface displacements; 1 if none

private:
    Fields() = default;
    /// Calls make(field, count, bytes of an element) for every field.
    template <class Make>
    void visit_extents(const FieldExtents& extents, Make make);

    FieldMemory memory_;
};

/// The kernels, with the quantities that each works on, in the kernels' order.
struct Kernels {
    Kernels(Device& device, const KernelBuild& build);

    Kernel<Field<Constants>, Field<Chosen>, Field<CellHead>> empty_cells;
    Kernel<Field<Constants>, Field<Blocks>, Field<ReplicaOfBlock>, Field<Position>, Field<CellHead>,
           Field<CellNext>>
        fill_cells;
    Kernel<int, Field<Constants>, Field<Blocks>, Field<ReplicaOfBlock>, Field<Position>, Field<CellHead>, Field<CellNext>,
           Field<Partner>, Field<Bulge>, Field<BulgeHistory>, Field<SpringX>, Field<SpringY>,
           Field<SpringZ>, Field<Deepest>, Field<Relaxed>, Field<ListedPosition>, Field<Status>>
        list_neighbours;
    Kernel<int, Field<Blocks>, Field<Partner>, Field<Mirror>> link_mirrors;
    Kernel<int, int, Field<Constants>, Field<Blocks>, Field<ReplicaOfBlock>, Field<StopAt>, Field<Position>,
           Field<Velocity>, Field<AngularVelocity>, Field<Position>, Field<Velocity>, Field<AngularVelocity>,
           Field<Partner>, Field<Mirror>, Field<Bulge>, Field<Bulge>, Field<BulgeHistory>,
           Field<SpringX>, Field<SpringY>, Field<SpringZ>, Field<Deepest>, Field<Relaxed>, Field<ListedPosition>, Field<Status>>
        advance;
    Kernel<Field<Constants>, Field<Blocks>, Field<ReplicaOfBlock>, Field<StopAt>, Field<Position>, Field<Velocity>,
           Field<AngularVelocity>, Field<Partner>, Field<Mirror>, Field<Bulge>, Field<SpringX>, Field<SpringY>,
           Field<SpringZ>, Field<Deepest>, Field<Relaxed>, Field<ListedPosition>, Field<ForceX>, Field<ForceY>, Field<ForceZ>, Field<Overlap>,
           Field<Arm>, Field<Energy>>
        measure;
    Kernel<Field<Constants>, Field<Chosen>, Field<Partner>, Field<ForceX>, Field<ForceY>, Field<ForceZ>,
           Field<Energy>, Field<Status>, Field<Reports>>
        reduce;

private:
    Kernels(Device& device, const cl::Program& program);
};

}  // namespace mcdem
