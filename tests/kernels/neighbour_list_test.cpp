// Cells, neighbour rows and partner slots against a loop over all pairs, and the state of slots when lists
// are rebuilt.
#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "kernels/saved_rows.h"
#include "sim/device_replica.h"

namespace mcdem::reference {
namespace {

/// Neighbours of a grain by a loop over all pairs. `unsure`: at the reach within rounding errors.
struct Near {
    std::vector<int> sure, unsure;
};

/// Distance to the nearest image in a periodic cell.
double distance(const mcdem::Box& box, Vec3 apart) {
    if (box.shape == mcdem::ContainerShape::periodic) {
        apart.x() = std::remainder(apart.x(), box.size_x);
        apart.y() = std::remainder(apart.y(), box.size_y);
    }
    return apart.norm();
}

Near near_by_brute_force(const StepReference& reference, const Start& start, int grain) {
    Near near;
    const auto sort_in = [&](int partner, double gap) {
        const double margin = 1e-6 * 0.02;
        if (gap < reference.reach() - margin)
            near.sure.push_back(partner);
        else if (gap < reference.reach() + margin)
            near.unsure.push_back(partner);
    };
    const auto& x = reference.position[grain];
    const mcdem::Box& box = start.replica.box;
    const double radius = start.packing.diameter[grain] / 2;
    for (std::size_t j = 0; j < start.packing.size(); ++j)
        if (int(j) != grain)
            sort_in(j, distance(box, reference.position[j] - x) - radius - start.packing.diameter[j] / 2);
    const Vec3 far(box.size_x, box.size_y, start.replica.plate.start);
    if (box.shape == mcdem::ContainerShape::cylinder)
        sort_in(mcdem::wall_partner(mcdem::Wall::x_min),
                box.size_x / 2 - std::hypot(x.x() - box.size_x / 2, x.y() - box.size_x / 2) - radius);
    for (int w = box.shape == mcdem::ContainerShape::box ? 0 : 4; w + 1 < mcdem::wall_count; ++w)
        sort_in(mcdem::wall_partner(static_cast<mcdem::Wall>(w)),
                (w % 2 ? far[w / 2] - x[w / 2] : x[w / 2]) - radius);
    const Vec3 slope(start.replica.effects.plate_tilt_x, start.replica.effects.plate_tilt_y, -1);
    const Vec3 middle(far.x() / 2, far.y() / 2, far.z());
    sort_in(mcdem::wall_partner(mcdem::Wall::plate), slope.dot(x - middle) / slope.norm() - radius);
    return near;
}

void expect_row(const SavedRows& rows, const StepReference& reference, const Start& start, int r, int grain) {
    const std::vector<int> row = rows.row(r, grain);
    const std::string where = fmt::format("replica {} grain {}", r, grain);
    const auto end = std::find(row.begin(), row.end(), NO_PARTNER);
    EXPECT_EQ(std::count(end, row.end(), NO_PARTNER), row.end() - end) << where << ": no holes";
    const auto walls = std::find_if(row.begin(), end, [](int entry) { return entry < NO_PARTNER; });
    EXPECT_TRUE(std::is_sorted(row.begin(), walls)) << where;
    EXPECT_TRUE(std::is_sorted(walls, end, std::greater<>())) << where << ": walls last, in their order";
    std::vector<int> found;
    for (auto entry = row.begin(); entry != end; ++entry) found.push_back(rows.user_partner(r, *entry));
    EXPECT_EQ(std::set<int>(found.begin(), found.end()).size(), found.size()) << where << ": none twice";
    const Near near = near_by_brute_force(reference, start, grain);
    for (int partner : near.sure)
        EXPECT_EQ(std::count(found.begin(), found.end(), partner), 1) << where << " misses " << partner;
    EXPECT_LE(found.size(), near.sure.size() + near.unsure.size()) << where << ": one too many";
}

void expect_mirrors(const SavedRows& rows, const KernelBuild& build) {
    const auto& partners = rows.partners();
    const auto partner_slots = rows.partner_slots();
    ASSERT_EQ(partner_slots.size(), partners.size());
    for (std::size_t slot = 0; slot < partners.size(); ++slot) {
        if (partners[slot] < 0) {
            EXPECT_FALSE(0 <= partner_slots[slot] && partner_slots[slot] < int(partners.size()))
                << "slot " << slot;
            continue;
        }
        ASSERT_EQ(build.grain_of_slot(partner_slots[slot]), partners[slot]) << "slot " << slot;
        ASSERT_EQ(partners[partner_slots[slot]], build.grain_of_slot(slot)) << "slot " << slot;
    }
}

void expect_lists(const KernelBuild& build, const std::vector<Start>& starts) {
    Batch batch(build, starts);
    std::vector<StepReference> references;
    for (std::size_t r = 0; r < starts.size(); ++r)
        references.push_back(reference_of(batch.engine(), r, starts[r]));
    const auto results = batch.advance(1);
    const SavedRows rows(batch, build, starts);
    for (std::size_t r = 0; r < starts.size(); ++r) {
        EXPECT_EQ(results[r].status & STATUS_SLOTS, 0);
        for (std::size_t i = 0; i < starts[r].packing.size(); ++i)
            expect_row(rows, references[r], starts[r], r, i);
    }
    expect_mirrors(rows, build);
}

Replica with_probe_gap(double gap) {
    Replica replica = test_replica();
    replica.numerics.probe_gap = gap;
    return replica;
}

TEST(NeighbourList, HoldsEveryPairForVariousNumbersOfGrains) {
    std::vector<Start> starts;
    for (int count : {1, 63, 64, 65, 1000, 2})
        starts.push_back(jittered_lattice(test_replica(), count, count));
    expect_lists(build(Precision::single_precision), starts);
    if (has_double()) expect_lists(build(Precision::double_precision), starts);
    if (has_other_way()) expect_lists(other_way(build(Precision::single_precision)), {starts[0], starts[3]});
}

TEST(NeighbourList, HoldsEveryPairWithLongRowsAndFewCells) {
    // a gap of 0.85 mean radii gives 18 neighbours; the whole box is one cell, or two per side
    expect_lists(build(Precision::single_precision, 32),
                 {jittered_lattice(with_probe_gap(0.85), 8, 1), jittered_lattice(with_probe_gap(0.85), 27, 2),
                  jittered_lattice(with_probe_gap(0.85), 125, 3)});
}

/// Small grains around large ones in a flat box; cells are as large as the largest pair.
Start gas(const Replica& replica) {
    Uniform uniform(4);
    Start start{replica, {}};
    start.replica.box = {0.3, 0.2};
    start.replica.plate.start = 0.05;
    for (int i = 0; i < 150; ++i) {
        start.packing.position.push_back(
            {uniform(0.005, 0.295), uniform(0.005, 0.195), uniform(0.005, 0.045)});
        start.packing.diameter.push_back(i % 10 ? uniform(0.004, 0.008) : uniform(0.02, 0.03));
    }
    return start;
}

TEST(NeighbourList, HoldsEveryPairOfVeryDifferentGrains) {
    expect_lists(build(Precision::single_precision, 64), {gas(test_replica())});
}

/// Two lattices of 64 grains that are `apart` [m], in a box that has far more cells than the cell list.
Start two_lattices_in_a_large_box(double size, const Vec3& apart) {
    Start start = jittered_lattice(test_replica(), 64, 8);
    start.replica.box = {size, size};
    start.replica.plate.start = size;
    start.replica.plate.end = 0.9 * size;
    for (int i = 0; i < 64; ++i) {
        start.packing.position.push_back(start.packing.position[i] + apart);
        start.packing.diameter.push_back(start.packing.diameter[i]);
    }
    return start;
}

// The cell list repeats along the box, so distant lattices are in the same cells.
TEST(NeighbourList, HoldsEveryPairInABoxMuchLargerThanItsGrains) {
    const Start probe = two_lattices_in_a_large_box(6, Vec3::Zero());
    const auto cells = mcdem::device_replica<mcdem::f32::Replica>(probe.replica, probe.packing, {});
    ASSERT_GT(cells.span_x, 10 * cells.cells_x);
    ASSERT_LE(mcdem::cell_count(cells), mcdem::max_cells(128));
    const double period = cells.cells_x * cells.cell_size[0];
    expect_lists(build(Precision::single_precision),
                 {two_lattices_in_a_large_box(6, {3, 2, 1}), two_lattices_in_a_large_box(6, {period, 0, 0}),
                  two_lattices_in_a_large_box(6, {period / 3, period / 3, period / 3})});
    if (has_double())
        expect_lists(build(Precision::double_precision), {two_lattices_in_a_large_box(900, {800, 0, 300}),
                                                          two_lattices_in_a_large_box(900, {0.07, 0, 0})});
}

/// Eight pairs of grains along one axis, in a box that has far more cells than the cell list.
Start pairs_on_a_line(int axis) {
    Start start = two_lattices_in_a_large_box(6, Vec3::Zero());
    start.packing = {};
    for (int i = 0; i < 16; ++i) {
        Vec3 x(1, 1, 1);
        x[axis] += 0.04 * (i / 2) + 0.019 * (i % 2);
        start.packing.position.push_back(x);
        start.packing.diameter.push_back(0.02);
    }
    return start;
}

// The 16 grains of a vector search one box of cells, but not if the cell list repeats within it.
TEST(NeighbourList, HoldsEveryPairIfTheGrainsOfAVectorAreFarApart) {
    const Start probe = pairs_on_a_line(0);
    const auto cells = mcdem::device_replica<mcdem::f32::Replica>(probe.replica, probe.packing, {});
    ASSERT_LT(std::max({cells.cells_x, cells.cells_y, cells.cells_z}) * cells.cell_size[0], 0.21);
    expect_lists(build(Precision::single_precision),
                 {pairs_on_a_line(0), pairs_on_a_line(1), pairs_on_a_line(2)});
}

Start in_cylinder(Start start) {
    const double radius = 0.1;
    start.replica.box = {2 * radius, 2 * radius, mcdem::ContainerShape::cylinder};
    for (Vec3& x : start.packing.position) {  // the box above is flat
        const double out = (radius - 0.005) * std::sqrt(x.x() / 0.3), angle = 40 * x.y();
        x = {radius + out * std::cos(angle), radius + out * std::sin(angle), x.z()};
    }
    return start;
}

Start repeated(Start start) {
    start.replica.box.shape = mcdem::ContainerShape::periodic;
    return start;
}

/// Two lattices at opposite boundaries of a periodic cell that has far more cells than the cell list.
Start lattices_across_ends(double size, const Vec3& apart) {
    Start start = repeated(two_lattices_in_a_large_box(size, apart));
    for (Vec3& x : start.packing.position) x -= Vec3(0.04, 0.03, 0);
    return start;
}

TEST(NeighbourList, HoldsEveryPairInACylinder) {
    expect_lists(build(Precision::single_precision, 64), {in_cylinder(gas(test_replica()))});
    expect_lists(build(Precision::single_precision),
                 {rings_in_a_cylinder(test_replica(), 3, 1), rings_in_a_cylinder(test_replica(), 1, 2)});
}

// Numbers of cells along a side: 2, 2, 3, 5, and more than the cell list has.
TEST(NeighbourList, HoldsEveryPairOfAPeriodicCell) {
    for (Precision precision : {Precision::single_precision, finest()})
        expect_lists(build(precision),
                     {periodic_lattice(test_replica(), 3, 3, 1), periodic_lattice(test_replica(), 3, 1, 2),
                      periodic_lattice(test_replica(), 4, 2, 3), periodic_lattice(test_replica(), 7, 2, 4)});
    if (has_other_way())
        expect_lists(other_way(build(Precision::single_precision)),
                     {periodic_lattice(test_replica(), 3, 3, 1), periodic_lattice(test_replica(), 5, 2, 4)});
    expect_lists(build(Precision::single_precision, 64), {repeated(gas(test_replica()))});
    const Start probe = lattices_across_ends(6, Vec3::Zero());
    const auto cells = mcdem::device_replica<mcdem::f32::Replica>(probe.replica, probe.packing, {});
    ASSERT_GT(cells.span_x, 10 * cells.cells_x);
    expect_lists(build(Precision::single_precision),
                 {lattices_across_ends(6, {3, 2, 1}), lattices_across_ends(6, {5.9, 0.02, 0.3})});
}

TEST(NeighbourList, HoldsATiltedPlate) {
    Replica replica = test_replica();
    replica.effects.plate_tilt_x = -0.2;
    replica.effects.plate_tilt_y = 0.1;
    expect_lists(build(Precision::single_precision, 64), {gas(replica)});
}

/// A loose cluster whose grains move past each other by about a radius.
Start mixing(FrictionLaw law, ContactModel model, const mcdem::Effects& effects = {}) {
    Replica replica = test_replica(model);
    replica.contact.friction_law = law;
    replica.effects = effects;
    replica.numerics.skin = 0.05;
    Start start = jittered_lattice(replica, 27, 31);
    start.replica.box.size_x *= 1.1;
    return start;
}

// Lists are rebuilt many times; a value that moved to the wrong neighbour would change the next forces. The
// motion is chaotic: rounding errors of 1e-16 grow by a factor of a few hundred, but not to 1e-9.
void expect_memory_moves_with_neighbours(const Start& start, const char* quantity, double size,
                                         double (*expected)(const Memory&), std::size_t stored_row) {
    const KernelBuild kernels = build(Precision::double_precision);
    Batch batch(kernels, start);
    Uniform uniform(5);
    batch.engine().set_velocities(0, uniform.vectors(27, 0.5), uniform.vectors(27, 20));
    StepReference reference = reference_of(batch.engine(), 0, start);
    int rebuilt = 0, changed = 0;
    bool differs = false;
    for (int step = 0; step < 120; ++step) {
        reference.set_time_step(batch.engine().time_step(0));
        const auto result = batch.advance(1).front();
        ASSERT_EQ(result.status, 0) << "step " << step;
        reference.step();
        const auto state = batch.engine().state(0);
        ASSERT_LT(relative_difference(state.position, reference.position), 1e-9) << "step " << step;
        ASSERT_LT(relative_difference(state.velocity, reference.velocity), 1e-9) << "step " << step;
        const SavedRows rows(batch, kernels, {start});
        for (int grain = 0; grain < 27; ++grain) {
            ASSERT_EQ(rows.by_partner(quantity, 0, grain).size(), reference.memory[grain].size());
            for (const auto& [partner, value] : rows.by_partner(quantity, 0, grain, stored_row)) {
                const Memory& memory = reference.memory[grain].at(partner);
                ASSERT_NEAR(value, expected(memory), 1e-9 * size) << "step " << step;
                differs |= std::abs(value) > 1e-3 * size;
            }
        }
        if (!rows.rebuilding(0)) continue;
        const auto before = reference.memory;
        reference.list_neighbours();
        ++rebuilt;
        for (int grain = 0; grain < 27; ++grain)
            for (const auto& [partner, memory] : before[grain])
                changed += !reference.memory[grain].count(partner);
    }
    EXPECT_GT(rebuilt, 10);
    EXPECT_GT(changed, 10) << "neighbours that were lost";
    EXPECT_TRUE(differs) << "nothing was remembered";
}

// Grains move farther than the list's margin several times within an interval while the plate moves down. An
// interval must end early rather than miss a contact. The reference examines all pairs in each step.
TEST(NeighbourList, LongIntervalsMissNoContact) {
    if (!has_double()) GTEST_SKIP() << "the device has no double precision";
    const Start start = mixing(FrictionLaw::saturated, ContactModel::independent);
    constexpr double plate_velocity = -0.003;
    Batch batch(build(Precision::double_precision), start);
    Uniform uniform(15);
    batch.engine().set_velocities(0, uniform.vectors(27, 0.5), uniform.vectors(27, 20));
    StepReference reference = reference_of(batch.engine(), 0, start);
    reference.begin(start.replica.plate.start, plate_velocity);
    double plate = start.replica.plate.start;
    int cut_short = 0;
    for (int interval = 0; interval < 60; ++interval) {
        const int asked = batch.engine().max_interval(0, {.plate_velocity = plate_velocity});
        ASSERT_GT(asked, 0);
        const auto result = batch.engine().advance({{asked, plate, plate_velocity, 0}}).front();
        ASSERT_EQ(result.status, 0);
        cut_short += result.steps < asked;
        for (int step = 0; step < result.steps; ++step) {
            reference.list_neighbours();
            reference.step();
        }
        plate += plate_velocity * result.steps * reference.time_step();
        reference.begin(plate, plate_velocity);
        ASSERT_LT(relative_difference(batch.engine().state(0).velocity, reference.velocity), 1e-9)
            << interval;
    }
    EXPECT_GT(cut_short, 3);
}

// Within an interval the plate may approach by at most a fifth of the margin; grains may use the rest.
TEST(NeighbourList, IntervalsEndBeforeThePlateLeavesTheMargin) {
    const Start start = jittered_lattice(test_replica(), 64, 16);
    Batch batch(build(Precision::single_precision), start);
    const double margin = 0.2 * start.replica.numerics.skin * 0.01;
    for (double velocity : {-10.0, -1.0, 0.01}) {
        const int steps = batch.engine().max_interval(0, {.plate_velocity = velocity});
        const double step = std::abs(velocity) * batch.engine().time_step(0);
        EXPECT_TRUE(steps == 1 || steps * step < 1.02 * margin) << velocity;
        EXPECT_GT((steps + 1) * step, steps == 60 ? 0 : 0.98 * margin)
            << velocity << ": no shorter than needed";
    }
    EXPECT_EQ(batch.engine().max_interval(0, {}), 60);
}

/// A value that a slot keeps between steps, where it is stored, and its size.
struct Kept {
    const char* what;
    FrictionLaw law;
    mcdem::Effects effects;
    double size, (*of)(const Memory&);
    std::size_t row = 0;
};

TEST(NeighbourList, MemoryMovesWithItsNeighbours) {
    if (!has_double()) GTEST_SKIP() << "the device has no double precision";
    expect_memory_moves_with_neighbours(
        mixing(FrictionLaw::saturated, ContactModel::mc_dem), "displacement", 0.01,
        [](const Memory& memory) { return memory.predicted; }, 0);
    const Kept all[] = {
        {"spring", FrictionLaw::mindlin, {}, 0.1, [](const Memory& m) { return m.spring.x(); }},
        {"radius", FrictionLaw::mindlin, {}, 0.01, [](const Memory& m) { return m.contact_radius; }, 3},
        {"deepest overlap",
         FrictionLaw::saturated,
         {.plasticity = 0.3},
         0.01,
         [](const Memory& m) { return m.deepest; }},
        {"relaxed force",
         FrictionLaw::saturated,
         {.viscoelasticity = 0.5, .relaxation_time = 3e-3},
         0.1,
         [](const Memory& m) { return m.relaxed; }},
        {"rolling spring",
         FrictionLaw::saturated,
         {.rolling_resistance = 0.3},
         1e-3,
         [](const Memory& m) { return m.rolling.x(); },
         1}};
    for (const Kept& kept : all) {
        SCOPED_TRACE(kept.what);
        expect_memory_moves_with_neighbours(mixing(kept.law, ContactModel::independent, kept.effects),
                                            "contact_memory", kept.size, kept.of, kept.row);
    }
}

}  // namespace
}  // namespace mcdem::reference
