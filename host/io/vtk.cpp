#include "io/vtk.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/atomic_file.h"
#include "core/container.h"
#include "core/make_folder.h"
#include "core/output_file.h"
#include "core/stress.h"
#include "io/folder_lock.h"
#include "io/grain_loads.h"
#include "io/hdf5.h"
#include "io/results.h"

namespace mcdem::inline io {
namespace {

// Cell types of VTK.
constexpr unsigned char vtk_vertex = 1, vtk_line = 3;

constexpr const char* readme = R"(Grains and contacts for ParaView
================================

replica_00000/grains_000000.hdf, ..     grains of replica 0, one file a scan
replica_00000/contacts_000000.hdf, ..   its contacts

1. Start ParaView (5.10 or later), File > Open, choose the group `grains_..hdf` of a replica (ParaView shows the
   numbered files as one time series), reader `VTKHDF`, Apply.
2. Grains: Filters > Glyph; Glyph Type `Sphere` with Radius 0.5, Orientation Array `No orientation array`,
   Scale Array `diameter`, Scale Factor 1, Glyph Mode `All Points`. Colour by `coordination_number`, `pressure`, a
   component of `stress` or `displacement_since_last_scan`.
3. Contacts: open `contacts_..hdf`, Filters > Extract Surface, then Filters > Tube; Scalars `force_magnitude`, Vary
   Radius `By Scalar`. Colour by `force_magnitude`: the force chains. For arrows: Filters > Glyph, `force`.

Lengths in metres, forces in newtons, stress in pascals, compression positive. `stress` of a grain has nine components:
xx, xy, xz, yx, .. (row: branch from centre to contact, column: force), over the volume of the undeformed sphere. Each
file carries frame, time, plate_z and top_force as field data. Walls are partners -1 to -6: x_min, x_max, y_min, y_max,
floor, plate. The side of a cylinder is partner -1. In a container that is periodic along x and y grains are where they
have moved to, also out of it; in a cell they are in an upright box of its lengths, and displacements are those beyond
the cell's own motion. Contacts end at a partner's nearest image.
)";

/// The parts of a VTKHDF unstructured grid, version 1.0, in one piece.
class Grid {
public:
    Grid(NewFile& out, unsigned char cell_type, long points_per_cell, const std::vector<double>& points)
        : file_(h5::File::create(out)) {
        const long count = static_cast<long>(points.size() / 3), cells = count / points_per_cell;
        file_.make_group("/VTKHDF");
        file_.set_attribute("/VTKHDF", "Version", std::vector<long>{1, 0});
        file_.set_attribute("/VTKHDF", "Type", std::string_view("UnstructuredGrid"));
        file_.write("/VTKHDF/NumberOfPoints", std::vector<long>{count});
        file_.write("/VTKHDF/NumberOfCells", std::vector<long>{cells});
        file_.write("/VTKHDF/NumberOfConnectivityIds", std::vector<long>{count});
        file_.write("/VTKHDF/Points", points, {3});
        std::vector<long> connectivity, offsets;
        for (long i = 0; i < count; ++i) connectivity.push_back(i);
        for (long c = 0; c <= cells; ++c) offsets.push_back(c * points_per_cell);
        file_.write("/VTKHDF/Connectivity", connectivity);
        file_.write("/VTKHDF/Offsets", offsets);
        file_.write("/VTKHDF/Types", std::vector<unsigned char>(static_cast<std::size_t>(cells), cell_type));
        for (const char* group : {"/VTKHDF/PointData", "/VTKHDF/CellData", "/VTKHDF/FieldData"})
            file_.make_group(group);
    }
    template <class Number>
    void point_data(const std::string& name, const std::vector<Number>& values, const h5::Extent& row = {}) {
        file_.write("/VTKHDF/PointData/" + name, values, row);
    }
    template <class Number>
    void cell_data(const std::string& name, const std::vector<Number>& values, const h5::Extent& row = {}) {
        file_.write("/VTKHDF/CellData/" + name, values, row);
    }
    void close_with(const Scan& scan) {
        field_data("frame", scan.frame);
        field_data("time", scan.time);
        field_data("plate_z", scan.plate_z);
        field_data("top_force", scan.top_force());
        file_.close();
    }

private:
    void field_data(const std::string& name, double value) {
        file_.write("/VTKHDF/FieldData/" + name, std::vector<double>{value});
    }
    h5::File file_;
};

void add(std::vector<double>& values, const Vec3& v) { values.insert(values.end(), {v.x(), v.y(), v.z()}); }

/// Positions at the first scan that has them and at the last one seen.
class Track {
public:
    explicit Track(const Box& box) : box_(box) {}

    Displacements see(const Scan& scan) {
        const Seen now{scan.position, scan.strain};
        if (first_.position.empty()) first_ = last_ = now;
        const Displacements moved{since(last_, now), since(first_, now)};
        last_ = now;
        return moved;
    }

private:
    struct Seen {
        std::vector<Vec3> position;
        Strain strain{};
    };
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

int export_replica(RunReader& reader, std::size_t replica, const std::filesystem::path& folder,
                   const ExportChoice& choice) {
    const Recording& recording = reader.run().recordings[replica];
    const auto sub = folder / fmt::format("replica_{:05}", replica);
    std::optional<FolderLock> lock;  // for what a killed export has left there
    Track track(recording.box);
    int files = 0;
    for (std::size_t s = 0; s < recording.scans.size(); ++s) {
        const Scan scan = reader.read_scan(replica, s);
        if (scan.position.empty()) continue;
        const Displacements moved = track.see(scan);
        if (!choice.has_scan(scan.frame)) continue;
        if (!lock) {
            make_folder(sub);
            lock.emplace(sub, FolderLock::Use::alone);
        }
        write_vtk_grains(sub / fmt::format("grains_{:06}.hdf", scan.frame), recording, scan, moved);
        write_vtk_contacts(sub / fmt::format("contacts_{:06}.hdf", scan.frame), recording, scan);
        files += 2;
    }
    return files;
}

void start_folder(const std::filesystem::path& folder) {
    make_folder(folder);
    replace_own(folder / "README.txt", FileKind::guide, readme);
}

}  // namespace

void write_vtk_grains(const std::filesystem::path& file, const Recording& recording, const Scan& scan,
                      const Displacements& moved) {
    const std::size_t grains = scan.position.size();
    const std::vector<GrainLoad> loads = grain_loads(scan);
    std::vector<double> points, force(grains), stress, pressure, since_start, since_last_scan;
    for (const Mat3& tensor : grain_stress(recording.box, recording.diameter, scan)) {
        stress.insert(stress.end(), tensor.data(), tensor.data() + tensor.size());
        pressure.push_back(tensor.trace() / 3);
    }
    for (const Vec3& by : moved.since_start) add(since_start, by);
    for (const Vec3& by : moved.since_last_scan) add(since_last_scan, by);
    std::vector<int> number(grains), contacts(grains);
    for (std::size_t i = 0; i < grains; ++i) {
        add(points, scan.position[i]);
        number[i] = static_cast<int>(i);
        contacts[i] = loads[i].contacts;
        force[i] = loads[i].force_magnitude;
    }
    replace_own(file, FileKind::vtk, [&](NewFile& out) {
        Grid grid(out, vtk_vertex, 1, points);
        grid.point_data("grain", number);
        grid.point_data("diameter", recording.diameter);
        if (!recording.species.empty()) grid.point_data("species", recording.species);
        grid.point_data("coordination_number", contacts);
        grid.point_data("force_magnitude", force);
        grid.point_data("stress", stress, {9});
        grid.point_data("pressure", pressure);
        grid.point_data("displacement", since_start, {3});
        grid.point_data("displacement_since_last_scan", since_last_scan, {3});
        grid.close_with(scan);
    });
}

void write_vtk_contacts(const std::filesystem::path& file, const Recording& recording, const Scan& scan) {
    std::vector<double> points, force, magnitude, normal, tangential, overlap, end_force, end_magnitude;
    std::vector<int> grain, partner;
    const Box now = deformed(recording.box, scan.strain);
    for (const Contact& contact : scan.contacts) {
        const Vec3& from = scan.position[static_cast<std::size_t>(contact.grain)];
        add(points, from);
        add(points,
            is_wall(contact.partner)
                ? wall_foot(recording.box, wall_of(contact.partner), scan.plate_z, from)
                : Vec3(from + apart(now, from, scan.position[static_cast<std::size_t>(contact.partner)])));
        add(force, contact.force);
        magnitude.push_back(contact.force.norm());
        end_magnitude.insert(end_magnitude.end(), 2, contact.force.norm());
        for (int end = 0; end < 2; ++end) add(end_force, contact.force);
        normal.push_back(normal_force(recording.box, scan, contact));
        tangential.push_back(
            std::sqrt(std::max(0.0, contact.force.squaredNorm() - normal.back() * normal.back())));
        overlap.push_back(contact.overlap);
        grain.push_back(contact.grain);
        partner.push_back(contact.partner);
    }
    replace_own(file, FileKind::vtk, [&](NewFile& out) {
        Grid grid(out, vtk_line, 2, points);
        grid.point_data("force", end_force, {3});  // glyphs and tubes take arrows and radius from points
        grid.point_data("force_magnitude", end_magnitude);
        grid.cell_data("grain", grain);
        grid.cell_data("partner", partner);
        grid.cell_data("force", force, {3});
        grid.cell_data("force_magnitude", magnitude);
        grid.cell_data("normal_force", normal);
        grid.cell_data("tangential_force", tangential);
        grid.cell_data("overlap", overlap);
        grid.close_with(scan);
    });
}

int export_vtk(const std::filesystem::path& file_or_folder, const std::filesystem::path& folder,
               const ExportChoice& choice) {
    RunReader reader(file_or_folder);
    expect_replicas(choice, reader.run());
    start_folder(folder);
    int files = 0;
    for (std::size_t r = 0; r < reader.run().recordings.size(); ++r)
        if (choice.has_replica(r)) files += export_replica(reader, r, folder, choice);
    return files;
}

}  // namespace mcdem::io
