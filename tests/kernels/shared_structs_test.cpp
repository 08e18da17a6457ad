// Structs shared by host and device (material.h, replica.h, report.h) have the same layout on both.
#include <cstddef>

#include "reference/test_scene.h"
#include "sim/device_types.h"

namespace reference {
namespace {

constexpr const char* offsets_kernel = R"(
#define AT(type, member) (int)((size_t)&(((type*)0)->member))
#define REPLICA(member) offsets[count++] = AT(Replica, member);
#define MATERIAL(member) offsets[count++] = AT(Material, member);
#define REPORT(member) offsets[count++] = AT(Report, member);
kernel void write_offsets(global int* offsets) {
    int count = 0;
    offsets[count++] = sizeof(Replica);
    offsets[count++] = sizeof(Material);
    offsets[count++] = sizeof(Report);
    MEMBERS
}
)";

// clang-format off
#define MEMBERS_OF_REPLICA(MEMBER) \
    MEMBER(material) MEMBER(time_step) MEMBER(drag) MEMBER(spin_drag) MEMBER(sliding_velocity) \
    MEMBER(confinement) MEMBER(skin) MEMBER(max_move) MEMBER(probe_gap) MEMBER(overlap_limit) MEMBER(cell_size) \
    MEMBER(wall_position) MEMBER(deformation) MEMBER(deformation_rate) \
    MEMBER(plate_velocity) MEMBER(first_grain) MEMBER(grain_count) \
    MEMBER(first_cell) MEMBER(cells_x) MEMBER(cells_y) MEMBER(cells_z) MEMBER(span_x) \
    MEMBER(span_y) MEMBER(span_z) MEMBER(surface) MEMBER(finite_contacts) MEMBER(mindlin) \
    MEMBER(memory_rows) MEMBER(radius_row) MEMBER(deepest_row) MEMBER(relaxed_row) MEMBER(rolling_row) MEMBER(steps_before) MEMBERS_OF_EFFECTS(MEMBER)
#define MEMBERS_OF_MATERIAL(MEMBER) \
    MEMBER(density) MEMBER(relative_density) MEMBER(weight_density) MEMBER(modulus) MEMBER(shear) \
    MEMBER(damping) MEMBER(friction) MEMBER(half_space_scale) MEMBER(half_space_normal) \
    MEMBER(half_space_shear) MEMBER(sphere_scale) MEMBER(sphere_point) MEMBER(sphere_size) \
    MEMBER(sphere_self) MEMBER(confinement_hertz) MEMBER(confinement_coupling) MEMBER(confinement_size) MEMBER(confinement_volume) MEMBER(confinement_shear) MEMBER(confinement_bulk) \
    MEMBER(grain_compliance) MEMBER(shear_compliance)
#define MEMBERS_OF_EFFECTS(MEMBER) \
    MEMBER(plate_tilt_x) MEMBER(plate_tilt_y) \
    MEMBER(adhesion) MEMBER(cohesion) MEMBER(net_force_friction) MEMBER(viscoelasticity) MEMBER(relaxing_share) MEMBER(stiffening) \
    MEMBER(plasticity) MEMBER(bulge_contacts) MEMBER(mindlin_share) MEMBER(rolling_resistance) \
    MEMBER(effects) MEMBER(container) MEMBER(slot_count) MEMBER(batch_size)
#define MEMBERS_OF_REPORT(MEMBER) \
    MEMBER(kinetic_energy) MEMBER(elastic_energy) MEMBER(weight_work) MEMBER(spring_energy) \
    MEMBER(work) MEMBER(damped) MEMBER(rubbed) MEMBER(dragged) MEMBER(moved_squared) \
    MEMBER(deepest_overlap) MEMBER(step_rate) MEMBER(wall_force) MEMBER(status) MEMBER(failed_grain)
// clang-format on

#define NAME_REPLICA(member) "REPLICA(" #member ")"
#define NAME_MATERIAL(member) "MATERIAL(" #member ")"
#define NAME_REPORT(member) "REPORT(" #member ")"
#define OFFSET_REPLICA(member) static_cast<int>(offsetof(Replica, member)),
#define OFFSET_MATERIAL(member) static_cast<int>(offsetof(Material, member)),
#define OFFSET_REPORT(member) static_cast<int>(offsetof(Report, member)),

template <class Replica, class Material, class Report>
std::vector<int> host_offsets() {
    return {static_cast<int>(sizeof(Replica)), static_cast<int>(sizeof(Material)),
            static_cast<int>(sizeof(Report)),
            MEMBERS_OF_REPLICA(OFFSET_REPLICA) MEMBERS_OF_MATERIAL(OFFSET_MATERIAL)
                MEMBERS_OF_REPORT(OFFSET_REPORT)};
}

std::vector<int> device_offsets(Precision precision, std::size_t count) {
    const auto kernels = build(precision);
    std::string source = mcdem::program_text() + offsets_kernel;
    const std::string members =
        MEMBERS_OF_REPLICA(NAME_REPLICA) MEMBERS_OF_MATERIAL(NAME_MATERIAL) MEMBERS_OF_REPORT(NAME_REPORT);
    source.replace(source.rfind("MEMBERS"), 7, members);
    cl::Program program(device().context(), source);
    const std::string options = "-cl-std=CL1.2 -DLANES=" + std::to_string(kernels.lanes) +
                                " -DSLOTS=16 -DBLOCK=16 -DLIST_ITEMS=16 -DMCDEM_DOUBLE=" +
                                (precision == Precision::double_precision ? "1" : "0");
    program.build({device().handle()}, options.c_str());
    struct Offsets;
    mcdem::Field<Offsets> field(device(), count, sizeof(int));
    mcdem::Kernel<mcdem::Field<Offsets>>(device(), program, "write_offsets", 1)(1, field);
    std::vector<int> offsets(count);
    field.read(offsets.data());
    return offsets;
}

TEST(SharedStructs, HaveTheSameLayoutInFloat) {
    const auto host = host_offsets<mcdem::f32::Replica, mcdem::f32::Material, mcdem::f32::Report>();
    EXPECT_EQ(device_offsets(Precision::single_precision, host.size()), host);
}

TEST(SharedStructs, HaveTheSameLayoutInDouble) {
    if (!has_double()) GTEST_SKIP() << "the device has no double precision";
    const auto host = host_offsets<mcdem::f64::Replica, mcdem::f64::Material, mcdem::f64::Report>();
    EXPECT_EQ(device_offsets(Precision::double_precision, host.size()), host);
}

// Every member is listed above: the sizes leave no room for another. (The last int may be padded.)
TEST(SharedStructs, AreListedCompletely) {
    const auto host = host_offsets<mcdem::f32::Replica, mcdem::f32::Material, mcdem::f32::Report>();
    const std::size_t replica_words = (sizeof(mcdem::f32::Replica) - sizeof(mcdem::f32::Material)) / 4 + 1 -
                                      3 * (6 - 1) - (3 - 1),
                      material_words = sizeof(mcdem::f32::Material) / 4 - 4 * MAX_SPECIES -
                                       (POINT_TERMS - 1) - (SIZE_TERMS - 1) - (SELF_TERMS - 1) - (3 - 1),
                      report_words = sizeof(mcdem::f32::Report) / 4 - 17;
    EXPECT_EQ(host.size() - 3, replica_words + material_words + report_words);
}

}  // namespace
}  // namespace reference
