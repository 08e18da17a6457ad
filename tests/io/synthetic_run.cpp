#include "io/synthetic_run.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>

namespace mcdem::test {
namespace {

constexpr double spacing = 0.02;  // [m]

Recording synthetic_recording(const Size& size, int replica) {
    const int side = static_cast<int>(std::ceil(std::cbrt(size.grains)));
    Recording recording;
    recording.label = "mc_dem, packing " + std::to_string(replica);
    recording.parameters = {{"grains.youngs_modulus", 23300.0},
                            {"contact.model", "mc_dem"},
                            {"seed", static_cast<std::uint64_t>(replica)}};
    recording.box = {side * spacing, side * spacing};
    recording.plate_start = side * spacing;
    for (int i = 0; i < size.grains; ++i) recording.diameter.push_back(spacing * (1 + 0.01 * (i % 3)));
    if (replica % 2) recording.species_names = {"soft", "half stiff"};
    for (int i = 0; i < size.grains && replica % 2; ++i) recording.species.push_back(i % 2);
    for (int s = 0; s < size.scans; ++s) {
        Scan scan;
        scan.frame = s;
        const int half = std::max(size.scans / 2, 1), depth = s < half ? s : size.scans - 1 - s;
        scan.phase = s < half ? Phase::load : Phase::unload;
        scan.time = 0.1 * s;
        scan.plate_z = recording.plate_start - 1e-3 * depth;
        scan.settled = s % 2 == 0;
        scan.kinetic_energy = 1e-9 / (s + 1);
        scan.elastic_energy = 1e-3 * depth + replica / 3.0;
        scan.wall_work = 1e-3 * s;
        scan.weight_work = -1e-4 * s;
        scan.damping_loss = 1e-5 * s;
        scan.friction_loss = 2e-5 * s;
        scan.drag_loss = 3e-5 * s;
        scan.energy_error = -1e-9 * s;
        scan.packing_fraction = std::numeric_limits<double>::quiet_NaN();
        scan.branch_length = spacing * 0.99;
        for (int i = 0; i < size.grains; ++i)
            scan.position.emplace_back((i % side + 0.5) * spacing, (i / side % side + 0.5) * spacing,
                                       (i / side / side + 0.5) * spacing - 1e-4 * depth + 1e-5 * replica);
        for (int i = 0; i < size.grains && replica % 3 != 2; ++i)  // measured recordings have none
            scan.rotation.emplace_back(0.01 * i, -0.02 * depth, 0.1 / (1 + replica));
        for (int i = 0; i < size.grains; ++i) {
            Contact contact;
            contact.grain = i;
            contact.force = Vec3(1e-4 * i, 0, 0.01 * (depth + 1) * (1 + std::sin(i)) / 3);
            contact.overlap = 1e-4 * depth;
            const Vec3& x = scan.position[static_cast<std::size_t>(i)];
            contact.partner = i + side * side < size.grains ? i + side * side : wall_partner(Wall::plate);
            contact.point = x + Vec3(0, 0, spacing / 2);
            scan.contacts.push_back(contact);
            if (i < side * side) {
                contact.partner = wall_partner(Wall::floor);
                contact.point = Vec3(x.x(), x.y(), 0);
                scan.contacts.push_back(contact);
            }
        }
        scan.coordination_number = 2.0 * static_cast<double>(scan.contacts.size()) / size.grains;
        scan.mean_force = 0.01 * (depth + 1) / 3;
        for (int wall = 0; wall < wall_count; ++wall) scan.wall_force[wall] = Vec3(wall, s, 1.0 / (1 + wall));
        scan.wall_force[static_cast<int>(Wall::plate)] = Vec3(0.01, -0.01, 0.5 * depth * (1 + 0.1 * replica));
        recording.scans.push_back(scan);
    }
    return recording;
}

bool same(double a, double b, double tolerance) {
    if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
    return std::abs(a - b) <= tolerance * std::abs(a);
}

bool same(const Vec3& a, const Vec3& b, double tolerance) {
    for (int k = 0; k < 3; ++k)
        if (!same(a[k], b[k], tolerance)) return false;
    return true;
}

std::string scan_difference(const Scan& a, const Scan& b, double tolerance) {
    if (a.frame != b.frame || a.cycle != b.cycle || a.phase != b.phase || a.settled != b.settled)
        return "numbering";
    if (!same(a.time, b.time, 0) || !same(a.plate_z, b.plate_z, 0)) return "time or plate_z";
    for (int wall = 0; wall < wall_count; ++wall)
        if (!same(a.wall_force[wall], b.wall_force[wall], 0)) return "wall_force";
    if (!same(a.kinetic_energy, b.kinetic_energy, 0) || !same(a.elastic_energy, b.elastic_energy, 0))
        return "energies";
    for (const auto term : {&Scan::wall_work, &Scan::weight_work, &Scan::damping_loss, &Scan::friction_loss,
                            &Scan::drag_loss, &Scan::energy_error})
        if (!same(a.*term, b.*term, 0)) return "energy budget";
    if (!same(a.coordination_number, b.coordination_number, 0) || !same(a.mean_force, b.mean_force, 0) ||
        !same(a.packing_fraction, b.packing_fraction, 0) || !same(a.branch_length, b.branch_length, 0))
        return "averages";
    if (a.position.size() != b.position.size()) return "number of positions";
    for (std::size_t i = 0; i < a.position.size(); ++i)
        if (!same(a.position[i], b.position[i], tolerance)) return "position of grain " + std::to_string(i);
    if (a.rotation.size() != b.rotation.size()) return "number of rotations";
    for (std::size_t i = 0; i < a.rotation.size(); ++i)
        if (!same(a.rotation[i], b.rotation[i], tolerance)) return "rotation of grain " + std::to_string(i);
    if (a.contacts.size() != b.contacts.size()) return "number of contacts";
    for (std::size_t c = 0; c < a.contacts.size(); ++c) {
        const Contact &x = a.contacts[c], &y = b.contacts[c];
        if (x.grain != y.grain || x.partner != y.partner || !same(x.point, y.point, tolerance) ||
            !same(x.force, y.force, tolerance) || !same(x.overlap, y.overlap, tolerance))
            return "contact " + std::to_string(c);
    }
    return "";
}

void expect_same(const Recording& a, const Recording& b, double tolerance) {
    EXPECT_EQ(a.label, b.label);
    EXPECT_EQ(a.parameters, b.parameters);
    EXPECT_EQ(a.box.size_x, b.box.size_x);
    EXPECT_EQ(a.box.size_y, b.box.size_y);
    EXPECT_EQ(a.box.shape, b.box.shape);
    EXPECT_EQ(a.plate_start, b.plate_start);
    EXPECT_EQ(a.diameter, b.diameter);
    EXPECT_EQ(a.species, b.species);
    EXPECT_EQ(a.species_names, b.species_names);
    ASSERT_EQ(a.failure.has_value(), b.failure.has_value());
    if (a.failure) {
        EXPECT_EQ(a.failure->step, b.failure->step);
        EXPECT_EQ(a.failure->grain, b.failure->grain);
        EXPECT_EQ(a.failure->cause, b.failure->cause);
    }
    ASSERT_EQ(a.scans.size(), b.scans.size());
    for (std::size_t s = 0; s < a.scans.size(); ++s)
        EXPECT_EQ(scan_difference(a.scans[s], b.scans[s], tolerance), "") << a.label << ", scan " << s;
}

}  // namespace

Run synthetic_run(const Size& size) {
    Run run;
    run.name = "synthetic";
    run.scene = "name = \"synthetic\"  # µm\n[grains]\nyoungs_modulus = 23300\n";
    run.program = "mcdem 0.1.0";
    run.device = "a device";
    run.precision = size.precision;
    for (int r = 0; r < size.replicas; ++r) run.recordings.push_back(synthetic_recording(size, r));
    return run;
}

Run part_of(const Run& run, std::size_t first, std::size_t last) {
    Run part = run;
    for (auto& recording : part.recordings) {
        const auto begin = recording.scans.begin(), end = recording.scans.end();
        const auto size = recording.scans.size();
        recording.scans = std::vector<Scan>(begin + static_cast<std::ptrdiff_t>(std::min(first, size)),
                                            last < size ? begin + static_cast<std::ptrdiff_t>(last) : end);
    }
    return part;
}

void expect_same(const Run& expected, const Run& found, double tolerance) {
    EXPECT_EQ(expected.name, found.name);
    EXPECT_EQ(expected.scene, found.scene);
    EXPECT_EQ(expected.program, found.program);
    EXPECT_EQ(expected.device, found.device);
    EXPECT_EQ(expected.precision, found.precision);
    ASSERT_EQ(expected.recordings.size(), found.recordings.size());
    for (std::size_t r = 0; r < expected.recordings.size(); ++r)
        expect_same(expected.recordings[r], found.recordings[r], tolerance);
}

Finished run_command(const std::string& command) {
    FILE* pipe = popen((command + " 2>&1").c_str(), "r");
    if (!pipe) return {-1, ""};
    std::string output;
    char part[4096];
    while (const std::size_t size = fread(part, 1, sizeof part, pipe)) output.append(part, size);
    const int status = pclose(pipe);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, output};
}

}  // namespace mcdem::test
