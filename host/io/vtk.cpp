#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>

#include "core/atomic_file.h"
#include "core/container.h"
#include "core/make_folder.h"
#include "core/output_file.h"
#include "core/stress.h"
#include "io/export_run.h"
#include "io/folder_lock.h"
#include "io/vtk_grid.h"

namespace mcdem::inline io {
namespace {

constexpr const char* readme = R"(Grains and contacts for ParaView
================================

A folder a replica, called after its number and label; in it, one file a scan:

grains_000000.hdf, ..     grains
contacts_000000.hdf, ..   contacts, as lines from centre to centre
forces_000000.hdf, ..     the same contacts as points where they are, with their forces
walls_000000.hdf, ..      walls as surfaces; edges where a container repeats

1. Start ParaView (5.10 or later), File > Open, choose the group `grains_..hdf` of a replica (ParaView shows the
   numbered files as one time series), reader `VTKHDF`, Apply.
2. Grains: Filters > Glyph; Glyph Type `Sphere` with Radius 0.5, Orientation Array `No orientation array`,
   Scale Array `diameter`, Scale Factor 1, Glyph Mode `All Points`. Colour by `coordination_number`, `pressure`, a
   component of `stress` or `displacement_since_last_scan`.
3. Contacts: open `contacts_..hdf`, Filters > Extract Surface, then Filters > Tube; Scalars `force_magnitude`, Vary
   Radius `By Scalar`. Colour by `force_magnitude`: the force chains.
4. Arrows: open `forces_..hdf`, Filters > Glyph; Glyph Type `Arrow`, Orientation Array and Scale Array `force`, Glyph
   Mode `All Points`. The force is that on `grain`; its partner feels the opposite one.
5. Walls: open `walls_..hdf`, Apply, Opacity 0.2. Colour by `wall`.

Lengths in metres, forces in newtons, stress in pascals, compression positive. `stress` of a grain has nine components:
xx, xy, xz, yx, .. (row: branch from centre to contact, column: force), over the volume of the undeformed sphere. Each
file carries frame, time, plate_z and top_force as field data, and the strains of a cell. Walls are partners -1 to -6: x_min, x_max, y_min, y_max,
floor, plate. The side of a cylinder is partner -1. In a container that is periodic along x and y grains are where they
have moved to, also out of it; in a cell they are in an upright box of its lengths, and displacements are those beyond
the cell's own motion. Contacts end at a partner's nearest image. The force of `walls` is that of all grains on the
wall, the same on each of its surfaces. `rotation` of a grain is since the start of the run, before the packing relaxes, as
axis times angle in radians. Without output.contacts grains have no coordination_number, force_magnitude, stress and pressure.

The replicas here, with the scene keys that are not the same in all of the run:
)";

void add(std::vector<double>& values, const Vec3& v) { values.insert(values.end(), {v.x(), v.y(), v.z()}); }

/// Displacement of every grain [m]; continuous when it crosses the border of a periodic cell. In a `cell`,
/// displacement beyond the cell's own motion.
struct Displacements {
    std::vector<Vec3> since_last_scan, since_start;  ///< of scans with positions
    std::vector<Vec3> rotation_since_last_scan;      ///< axis times angle [rad]; empty if not recorded
};

/// Positions of grains at the first scan with positions and at the last one seen.
class Track {
public:
    explicit Track(const Box& box) : box_(box) {}

    Displacements see(const Scan& scan) {
        const Seen now{scan.position, scan.rotation, scan.strain};
        if (first_.position.empty()) first_ = last_ = now;
        const Displacements moved{since(last_, now), since(first_, now),
                                  rotation_since(last_.rotation, now.rotation)};
        last_ = now;
        return moved;
    }

private:
    struct Seen {
        std::vector<Vec3> position, rotation;
        Strain strain{};
    };
    static std::vector<Vec3> rotation_since(const std::vector<Vec3>& before, const std::vector<Vec3>& now) {
        const auto matrix = [](const Vec3& turn) {
            return Eigen::AngleAxisd(turn.norm(), turn.stableNormalized()).toRotationMatrix();
        };
        std::vector<Vec3> turns;
        for (std::size_t i = 0; i < std::min(before.size(), now.size()); ++i) {
            const Eigen::AngleAxisd turn(Mat3(matrix(now[i]) * matrix(before[i]).transpose()));
            turns.push_back(turn.angle() * turn.axis());
        }
        return turns;
    }
    std::vector<Vec3> since(const Seen& before, const Seen& now) const {
        const Mat3 motion = deformation(now.strain) * inverse_deformation(before.strain);
        const Box box = deformed(box_, now.strain);
        std::vector<Vec3> moved;
        for (std::size_t i = 0; i < now.position.size(); ++i)
            moved.push_back(is_cell(box) ? apart(box, motion * before.position[i], now.position[i])
                                         : Vec3(now.position[i] - before.position[i]));
        return moved;
    }
    Box box_;
    Seen first_, last_;
};

/// Data of contacts, one row each.
struct ContactRows {
    explicit ContactRows(const Recording& recording, const Scan& scan) {
        for (const Contact& contact : scan.contacts) {
            add(force, contact.force);
            magnitude.push_back(contact.force.norm());
            normal.push_back(normal_force(recording.box, scan, contact));
            tangential.push_back(
                std::sqrt(std::max(0.0, contact.force.squaredNorm() - normal.back() * normal.back())));
            overlap.push_back(contact.overlap);
            grain.push_back(contact.grain);
            partner.push_back(contact.partner);
        }
    }
    /// Calls `write(name, values, row)` for data on the grid's points or cells.
    void write_with(const auto& write) const {
        write("grain", grain, h5::Extent{});
        write("partner", partner, h5::Extent{});
        write("force", force, h5::Extent{3});
        write("force_magnitude", magnitude, h5::Extent{});
        write("normal_force", normal, h5::Extent{});
        write("tangential_force", tangential, h5::Extent{});
        write("overlap", overlap, h5::Extent{});
    }
    std::vector<double> force, magnitude, normal, tangential, overlap;
    std::vector<int> grain, partner;
};

/// `add_data` adds the data of points and cells.
void write_grid(const std::filesystem::path& file, const VtkCells& cells, const Recording& recording,
                const Scan& scan, const std::function<void(VtkGrid&)>& add_data) {
    replace_own(file, FileKind::vtk, [&](NewFile& out) {
        VtkGrid grid(out, cells);
        add_data(grid);
        grid.close_with(scan, recording.box);
    });
}

/// Grains as points with: grain, diameter; if contacts are known coordination_number, force_magnitude (sum of
/// |force| [N]), stress (core/stress.h), pressure (a third of its trace); displacement and
/// displacement_since_last_scan; if known, rotation (since the start, before the packing relaxes) and
/// rotation_since_last_scan, axis times angle [rad].
void write_vtk_grains(const std::filesystem::path& file, const Recording& recording, const Scan& scan,
                      const Displacements& moved) {
    const std::size_t grains = scan.position.size();
    const std::vector<GrainLoad> loads = grain_loads(scan);
    VtkCells points;
    std::vector<double> force(grains), stress, pressure, since_start, since_last_scan, rotation,
        rotation_since_last_scan;
    if (scan.knows_contacts())
        for (const Mat3& tensor : grain_stress(recording.box, recording.diameter, scan)) {
            stress.insert(stress.end(), tensor.data(), tensor.data() + tensor.size());
            pressure.push_back(tensor.trace() / 3);
        }
    for (const Vec3& by : moved.since_start) add(since_start, by);
    for (const Vec3& by : moved.since_last_scan) add(since_last_scan, by);
    for (const Vec3& by : scan.rotation) add(rotation, by);
    for (const Vec3& by : moved.rotation_since_last_scan) add(rotation_since_last_scan, by);
    std::vector<int> number(grains), contacts(grains);
    for (std::size_t i = 0; i < grains; ++i) {
        points.add(VtkCell::vertex, {scan.position[i]});
        number[i] = static_cast<int>(i);
        contacts[i] = loads[i].contacts;
        force[i] = loads[i].force_magnitude;
    }
    write_grid(file, points, recording, scan, [&](VtkGrid& grid) {
        grid.point_data("grain", number);
        grid.point_data("diameter", recording.diameter);
        if (!recording.species.empty()) grid.point_data("species", recording.species);
        if (scan.knows_contacts()) {
            grid.point_data("coordination_number", contacts);
            grid.point_data("force_magnitude", force);
            grid.point_data("stress", stress, {9});
            grid.point_data("pressure", pressure);
        }
        grid.point_data("displacement", since_start, {3});
        grid.point_data("displacement_since_last_scan", since_last_scan, {3});
        if (rotation.size() == since_start.size()) grid.point_data("rotation", rotation, {3});
        if (rotation_since_last_scan.size() == since_start.size())
            grid.point_data("rotation_since_last_scan", rotation_since_last_scan, {3});
    });
}

/// Contacts as lines from the grain's centre to that of its partner, or to the foot on the wall, with: grain,
/// partner, force (on the grain; also at the ends), force_magnitude, normal_force, tangential_force, overlap.
void write_vtk_contacts(const std::filesystem::path& file, const Recording& recording, const Scan& scan) {
    VtkCells lines;
    std::vector<double> end_force, end_magnitude;
    const Box now = deformed(recording.box, scan.strain);
    for (const Contact& contact : scan.contacts) {
        const Vec3& from = scan.position[contact.grain];
        const Vec3 to = is_wall(contact.partner)
                            ? wall_foot(recording.box, wall_of(contact.partner), scan.plate_z, from)
                            : Vec3(from + apart(now, from, scan.position[contact.partner]));
        lines.add(VtkCell::line, {from, to});
        end_magnitude.insert(end_magnitude.end(), 2, contact.force.norm());
        for (int end = 0; end < 2; ++end) add(end_force, contact.force);
    }
    const ContactRows rows(recording, scan);
    write_grid(file, lines, recording, scan, [&](VtkGrid& grid) {
        grid.point_data("force", end_force, {3});  // tubes take their radius from point data
        grid.point_data("force_magnitude", end_magnitude);
        rows.write_with([&](const char* name, const auto& values, const h5::Extent& row) {
            grid.cell_data(name, values, row);
        });
    });
}

/// The same contacts as points at their positions, with the same data on points.
void write_vtk_forces(const std::filesystem::path& file, const Recording& recording, const Scan& scan) {
    VtkCells points;
    for (const Contact& contact : scan.contacts) points.add(VtkCell::vertex, {contact.point});
    const ContactRows rows(recording, scan);
    write_grid(file, points, recording, scan, [&](VtkGrid& grid) {
        rows.write_with([&](const char* name, const auto& values, const h5::Extent& row) {
            grid.point_data(name, values, row);
        });
    });
}

/// Cells with the wall of each; -1: an edge of a periodic container. Side walls extend from the floor to the
/// initial height of the plate; a `cell` is drawn as the upright cell that contains the positions.
struct VtkWalls {
    VtkCells cells;
    std::vector<int> wall;
};

constexpr int sides = 64;  ///< of the polygon that approximates a circle

/// The floor's corners, counterclockwise as seen from above.
std::vector<Vec3> corners_of(const Box& box) {
    if (!is_cylinder(box))
        return {{0, 0, 0}, {box.size_x, 0, 0}, {box.size_x, box.size_y, 0}, {0, box.size_y, 0}};
    std::vector<Vec3> corners;
    for (int n = 0; n < sides; ++n) {
        const double angle = 2 * std::numbers::pi * n / sides;
        corners.push_back(cylinder_radius(box) * Vec3(1 + std::cos(angle), 1 + std::sin(angle), 0));
    }
    return corners;
}

/// The wall above the edge from corner n to the next one; -1: none.
int wall_over(const Box& box, std::size_t n) {
    if (is_cylinder(box)) return static_cast<int>(curved_wall);
    if (is_periodic(box)) return -1;
    constexpr Wall walls[]{Wall::y_min, Wall::x_max, Wall::y_max, Wall::x_min};
    return static_cast<int>(walls[n]);
}

class Builder {
public:
    explicit Builder(const Box& box) : corners_(corners_of(box)), box_(box) {}

    void level(Wall wall, double height) {
        std::vector<Vec3> face = corners_;
        for (Vec3& corner : face) corner.z() = height;
        add(VtkCell::polygon, static_cast<int>(wall), face);
    }
    void edges_at(double height) {
        const Vec3 up(0, 0, height);
        for (std::size_t n = 0; n < corners_.size(); ++n)
            add(VtkCell::line, -1, {corners_[n] + up, next(n) + up});
    }
    /// Side walls, or vertical edges if there are none.
    void upright(double height) {
        const Vec3 up(0, 0, height);
        for (std::size_t n = 0; n < corners_.size(); ++n) {
            const Vec3 &here = corners_[n], &there = next(n);
            if (const int wall = wall_over(box_, n); wall >= 0)
                add(VtkCell::polygon, wall, {here, there, there + up, here + up});
            else
                add(VtkCell::line, -1, {here, here + up});
        }
    }
    VtkWalls made;

private:
    const Vec3& next(std::size_t n) const { return corners_[(n + 1) % corners_.size()]; }
    void add(VtkCell type, int wall, const std::vector<Vec3>& corners) {
        made.cells.add(type, corners);
        made.wall.push_back(wall);
    }
    std::vector<Vec3> corners_;
    Box box_;
};

VtkWalls vtk_walls(const Recording& recording, const Scan& scan) {
    const Box now = deformed(recording.box, scan.strain);
    Builder walls(now);
    if (is_cell(now)) {
        walls.upright(now.height);
        walls.edges_at(0);
        walls.edges_at(now.height);
        return walls.made;
    }
    walls.upright(std::max(recording.plate_start, scan.plate_z));
    walls.level(Wall::floor, 0);
    walls.level(Wall::plate, scan.plate_z);
    return walls.made;
}

/// Walls with: wall (-1: an edge), force (total force on the wall by the grains).
void write_vtk_walls(const std::filesystem::path& file, const Recording& recording, const Scan& scan) {
    const VtkWalls walls = vtk_walls(recording, scan);
    std::vector<double> force;
    for (const int wall : walls.wall) add(force, wall < 0 ? Vec3(Vec3::Zero()) : scan.wall_force[wall]);
    write_grid(file, walls.cells, recording, scan, [&](VtkGrid& grid) {
        grid.cell_data("wall", walls.wall);
        grid.cell_data("force", force, {3});
    });
}

/// Whether a file is called as those of an export: "grains_000012.hdf".
bool is_numbered(const std::string& name) {
    for (const std::string what : {"grains_", "contacts_", "forces_", "walls_"})
        if (name.starts_with(what) && name.ends_with(".hdf"))
            return std::all_of(name.begin() + static_cast<std::ptrdiff_t>(what.size()), name.end() - 4,
                               [](unsigned char c) { return c >= '0' && c <= '9'; });
    return false;
}

/// Removes the numbered files of an earlier export into this folder that the new one has not replaced:
/// ParaView would show them in the same time series.
void remove_others(const std::filesystem::path& folder, const std::set<std::filesystem::path>& kept) {
    std::vector<std::filesystem::path> old;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (is_numbered(entry.path().filename().string()) && !kept.count(entry.path()))
            old.push_back(entry.path());
    for (const auto& file : old) std::filesystem::remove(file);
}

int export_vtk_replica(RunReader& reader, std::size_t replica, const std::filesystem::path& folder,
                       const ExportChoice& choice) {
    const Recording& recording = reader.run().recordings[replica];
    const auto sub = folder / export_name(replica, recording.label);
    std::optional<FolderLock> lock;  // protects temporary files of a killed export
    Track track(recording.box);
    std::set<std::filesystem::path> files;
    for (std::size_t s = 0; s < recording.scans.size(); ++s) {
        const Scan scan = reader.read_scan(replica, s);
        if (scan.position.empty()) continue;
        const Displacements moved = track.see(scan);
        if (!choice.has_scan(scan.frame)) continue;
        if (!lock) {
            make_folder(sub);
            lock.emplace(sub, FolderLock::Use::alone);
        }
        const auto file = [&](const char* what) {
            return *files.insert(sub / fmt::format("{}_{:06}.hdf", what, scan.frame)).first;
        };
        write_vtk_grains(file("grains"), recording, scan, moved);
        write_vtk_contacts(file("contacts"), recording, scan);
        write_vtk_forces(file("forces"), recording, scan);
        write_vtk_walls(file("walls"), recording, scan);
    }
    if (lock) remove_others(sub, files);
    return static_cast<int>(files.size());
}

}  // namespace

int export_vtk(const std::filesystem::path& file_or_folder, const std::filesystem::path& folder,
               const ExportChoice& choice) {
    return export_replicas(file_or_folder, folder, choice, {"README.txt", readme}, export_vtk_replica);
}

}  // namespace mcdem::io
