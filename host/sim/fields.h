// Device memory of a batch, one field per quantity, and the kernels that use it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

#include "cl/kernel.h"
#include "cl/program.h"

namespace mcdem::inline sim {

// Tag types of the quantities.
struct Constants;
struct Materials;
struct Blocks;
struct Portions;
struct StopAt;
struct Motion;
struct Partner;
struct PartnerSlot;
struct SurfaceDisplacement;
struct DisplacementHistory;
struct ContactMemory;
struct Tracks;
struct Status;
struct CellHead;
struct CellNext;
struct Force;
struct Overlap;
struct Arm;
struct Energy;
struct Reports;
struct CellMoments;

/// Double-buffered field: a step reads `now` of the neighbours and writes `next`; then they are swapped.
template <class Quantity>
struct Pair {
    Field<Quantity> copies[2];
    Now<Quantity> now(int parity) { return {copies[parity]}; }
    Next<Quantity> next(int parity) { return {copies[1 - parity]}; }
};

/// Number of reals of a grain in the field Motion: position, radius, velocity, excess compliance, angular
/// velocity, species.
inline constexpr std::size_t reals_of_motion = 12;

/// Number of reals of a grain in the field Tracks: position at the last list rebuild and one unused,
/// rotation, work in the interval.
inline constexpr std::size_t reals_of_track = 12;
/// .. in the field Energy: energies and rates that are summed over a replica.
inline constexpr std::size_t reals_of_energy = 8;

/// Optional fields that a batch needs.
struct FieldNeeds {
    bool displacements = false;  ///< some replica has interacting contacts
    bool springs = false;        ///< some replica has friction with history
    bool deepest = false;        ///< some replica has plasticity
    bool relaxed = false;        ///< some replica has viscoelasticity
    bool rolling = false;        ///< some replica has rolling resistance
    bool cells = false;          ///< some replica is a cell
};

/// Number of rows of a grain's contact memory (kernels/contact_memory.h). Springs, if present, use the first
/// three; with springs or rolling resistance there is one of contact radii.
struct MemoryRows {
    int count = 0, radius = 0, deepest = 0, relaxed = 0, rolling = 0;
};
MemoryRows memory_rows(const FieldNeeds& needs);

/// Extents of the fields of a batch.
struct FieldExtents {
    std::uint64_t replicas = 0, blocks = 0, portions = 0, grains = 0, cells = 0;  ///< grains: padded
    std::uint64_t slots = 0;                                                      ///< per grain
    std::uint64_t species = 1;                                                    ///< materials per replica
    Precision precision = Precision::single_precision;
    FieldNeeds needs;
};

/// Device memory of a batch [bytes].
struct FieldMemory {
    std::uint64_t all = 0, largest_field = 0;
};

/// Fields have one element per grain (padded, all replicas) unless a comment says otherwise.
struct Fields {
    Fields(Device& device, const FieldExtents& extents);

    /// Memory of fields with these extents, computed without a device.
    static FieldMemory memory_of(const FieldExtents& extents);

    Field<Constants> replicas;   ///< per replica
    Field<Materials> materials;  ///< per species of a replica
    Field<StopAt> stop_at;       ///< per replica: steps in this interval; then the number of replicas taken
    Field<Reports> reports;      ///< per active portion
    Field<CellMoments> cell_moments;       ///< per active portion, 9 reals each
    Field<Portions> portions, rebuilt;     ///< per active portion
    Field<Blocks> blocks, rebuilt_blocks;  ///< per active block
    Field<Blocks> first_blocks;            ///< per active replica
    Pair<Motion> motion;
    Field<Tracks> tracks;
    Field<Status> status;
    Field<Energy> energy;
    Field<Partner> partner;                  ///< per slot, like all fields below
    Field<PartnerSlot> partner_slot;         ///< index into displacement; slot_count if there is none
    Pair<SurfaceDisplacement> displacement;  ///< with one more element at slot_count, always zero
    Field<DisplacementHistory> displacement_history;  ///< per slot, for each of the last four steps
    Field<ContactMemory> memory_of_contacts;          ///< rows of a grain, contiguous
    Field<Force> force;                               ///< three rows of a grain, contiguous: along x, y and z
    Field<Overlap> overlap;
    Field<Arm> arm;
    Field<CellHead> cell_head;  ///< per cell
    Field<CellNext> cell_next;

    /// Calls visit(name, field) for every field that a checkpoint must contain.
    template <class Visit>
    void visit_state(Visit visit) {
        visit("motion", motion.copies[0]);
        visit("tracks", tracks);
        visit("status", status);
        visit("partner", partner);
        visit("partner_slot", partner_slot);
        visit("displacement", displacement.copies[0]);
        visit("displacement_history", displacement_history);
        visit("contact_memory", memory_of_contacts);
    }
    FieldMemory memory() const { return memory_; }
    /// Whether the surfaces of any replica move; otherwise partner slots are not used.
    bool has_displacements() const { return slot_count > 1; }
    bool has_cells() const { return has_cells_; }
    int slot_count = 0;  ///< total over all grains with surface displacements; 1 if none

private:
    Fields() = default;
    /// Calls make(field, count, bytes per element) for every field.
    template <class Make>
    void visit_extents(const FieldExtents& extents, Make make);

    FieldMemory memory_;
    bool has_cells_ = false;
};

/// The kernels, with the types of their arguments.
struct Kernels {
    Kernels(Device& device, const KernelBuild& build);

    Kernel<Field<Constants>, Field<Portions>, Field<CellHead>> empty_cells;
    Kernel<int, Field<Constants>, Field<Blocks>, Now<Motion>, Field<CellHead>, Field<CellNext>> fill_cells;
    Kernel<int, Field<Constants>, Field<Blocks>, Now<Motion>, Field<CellHead>, Field<CellNext>,
           Field<Partner>, Now<SurfaceDisplacement>, Field<DisplacementHistory>, Field<ContactMemory>,
           Field<Tracks>, Field<Status>>
        list_neighbours;
    Kernel<int, int, Field<Blocks>, Field<Partner>, Field<PartnerSlot>> link_partner_slots;
    Kernel<int, int, Field<Constants>, Field<Materials>, Field<Blocks>, Field<StopAt>, Now<Motion>,
           Next<Motion>, Field<Partner>, Field<PartnerSlot>, Now<SurfaceDisplacement>,
           Next<SurfaceDisplacement>, Field<DisplacementHistory>, Field<ContactMemory>, Field<Tracks>,
           Field<Status>>
        advance;
    Kernel<Field<Constants>, Field<Materials>, Field<Blocks>, Field<StopAt>, Now<Motion>, Field<Partner>,
           Field<PartnerSlot>, Now<SurfaceDisplacement>, Field<ContactMemory>, Field<Tracks>, Field<Force>,
           Field<Overlap>, Field<Arm>, Field<Energy>>
        measure;
    Kernel<Field<Constants>, Field<Portions>, Field<Partner>, Field<Force>, Field<Energy>, Field<Tracks>,
           Field<Status>, Field<Reports>>
        reduce;
    Kernel<Field<Constants>, Field<Portions>, Field<StopAt>, Now<Motion>, Field<Partner>, Field<Force>,
           Field<CellMoments>>
        cell_stress;

private:
    Kernels(Device& device, const KernelBuild& build, const cl::Program& program);
};

}  // namespace mcdem::sim
