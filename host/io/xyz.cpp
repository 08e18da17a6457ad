#include <fmt/format.h>

#include <algorithm>

#include "core/atomic_file.h"
#include "core/container.h"
#include "core/errors.h"
#include "core/output_file.h"
#include "io/export_run.h"

namespace mcdem::inline io {
namespace {

const char* const how_to_look = R"(replica_*.xyz            grains, one frame a scan, SI units (extended XYZ)
replica_*.contacts.dump  contacts between grains, the same frames (LAMMPS dump local)

OVITO: load a .xyz file. For contacts as bonds add the modifier "Load trajectory", open the .contacts.dump file in it
and name its columns: Particle Identifiers.1, Particle Identifiers.2, force_magnitude, force_x, force_y, force_z,
overlap. Colour and width of the bonds can follow force_magnitude [N]. In Python:

    from ovito.io import import_file
    from ovito.modifiers import LoadTrajectoryModifier
    pipeline = import_file("NAME.xyz")
    contacts = LoadTrajectoryModifier()
    contacts.source.load("NAME.contacts.dump", columns=["Particle Identifiers.1",
        "Particle Identifiers.2", "force_magnitude", "force_x", "force_y", "force_z", "overlap"])
    pipeline.modifiers.append(contacts)

Of a grain: its species as particle type (column element; in ASE an array of that name), radius [m], id, coordination_number (walls counted), force_magnitude (sum of its contacts' [N]), wall_force
(by the walls [N]). In a container that is periodic along x and y grains are where they have moved to, also out of it:
modifier "Wrap at periodic boundaries". In a cell they are in an upright box of its lengths. Of a contact: its force on the first of the two grains [N], its overlap [m].

The replicas here, each a NAME, with the scene keys that are not the same in all of the run:
)";

/// In double quotes; extended XYZ cannot represent a double quote.
std::string in_quotes(std::string text) {
    std::ranges::replace(text, '"', '\'');
    std::ranges::replace(text, '\n', ' ');
    return '"' + text + '"';
}

/// A single word, as the format requires. The column is called `element`: OVITO takes it for the particle
/// type as it takes `species`, which ASE requires to be a chemical element.
std::string particle_type(const Recording& recording, std::size_t grain) {
    if (recording.species.empty()) return "X";
    std::string word = recording.species_names[recording.species[grain]];
    std::ranges::replace(word, ' ', '_');
    return word;
}

void append_grains(fmt::memory_buffer& text, const Recording& recording, const Scan& scan) {
    const auto out = fmt::appender(text);
    const Box now = deformed(recording.box, scan.strain);
    fmt::format_to(
        out,
        "{}\nLattice=\"{:.9g} 0 0 {:.9g} {:.9g} 0 {:.9g} {:.9g} {:.9g}\" Origin=\"0 0 0\" pbc=\"{}\" "
        "Properties=element:S:1:pos:R:3:id:I:1:radius:R:1:coordination_number:I:1:force_magnitude:R:1:"
        "wall_force:R:3 Time={:.9g} frame={} cycle={} phase={} plate_z={:.9g} top_force={:.9g} label={}\n",
        scan.position.size(), now.size_x, now.tilt_xy, now.size_y, now.tilt_xz, now.tilt_yz,
        is_cell(now) ? now.height : recording.plate_start,
        is_cell(now)       ? "T T T"
        : is_periodic(now) ? "T T F"
                           : "F F F",
        scan.time, scan.frame, scan.cycle, name(scan.phase), scan.plate_z, scan.top_force(),
        in_quotes(recording.label));
    const auto loads = grain_loads(scan);
    for (std::size_t i = 0; i < scan.position.size(); ++i) {
        const Vec3 &at = scan.position[i], &wall = loads[i].wall_force;
        fmt::format_to(out, "{} {:.9g} {:.9g} {:.9g} {} {:.9g} {} {:.9g} {:.9g} {:.9g} {:.9g}\n",
                       particle_type(recording, i), at.x(), at.y(), at.z(), i, recording.diameter[i] / 2,
                       loads[i].contacts, loads[i].force_magnitude, wall.x(), wall.y(), wall.z());
    }
}

/// As LAMMPS writes them: for a tilted cell, the bounding box.
std::string dump_bounds(const Recording& recording, const Scan& scan) {
    const Box now = deformed(recording.box, scan.strain);
    if (!is_cell(now))
        return fmt::format("ITEM: BOX BOUNDS {} ff\n0 {:.9g}\n0 {:.9g}\n0 {:.9g}\n",
                           is_periodic(now) ? "pp pp" : "ff ff", now.size_x, now.size_y,
                           recording.plate_start);
    const auto [low, high] = std::minmax({0.0, now.tilt_xy, now.tilt_xz, now.tilt_xy + now.tilt_xz});
    return fmt::format(
        "ITEM: BOX BOUNDS xy xz yz pp pp pp\n{:.9g} {:.9g} {:.9g}\n{:.9g} {:.9g} {:.9g}\n0 {:.9g} "
        "{:.9g}\n",
        low, now.size_x + high, now.tilt_xy, std::min(0.0, now.tilt_yz),
        now.size_y + std::max(0.0, now.tilt_yz), now.tilt_xz, now.height, now.tilt_yz);
}

void append_contacts(fmt::memory_buffer& text, const Recording& recording, const Scan& scan) {
    const auto out = fmt::appender(text);
    const auto between_grains =
        std::ranges::count_if(scan.contacts, [](const Contact& c) { return !is_wall(c.partner); });
    fmt::format_to(out,
                   "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ENTRIES\n{}\n{}"
                   "ITEM: ENTRIES grain partner force_magnitude fx fy fz overlap\n",
                   scan.frame, between_grains, dump_bounds(recording, scan));
    for (const Contact& contact : scan.contacts)
        if (!is_wall(contact.partner))
            fmt::format_to(out, "{} {} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n", contact.grain, contact.partner,
                           contact.force.norm(), contact.force.x(), contact.force.y(), contact.force.z(),
                           contact.overlap);
}

/// Writes both files of one replica, reading its scans one by one.
int export_xyz_replica(RunReader& reader, std::size_t number, const std::filesystem::path& folder,
                       const ExportChoice& choice) {
    const Recording& recording = reader.run().recordings[number];
    const auto write_frames = [&](NewFile& out, auto append) {
        bool any = false;
        for (std::size_t s = 0; s < recording.scans.size(); ++s) {
            if (!choice.has_scan(recording.scans[s].frame)) continue;
            const Scan scan = reader.read_scan(number, s);
            if (scan.position.empty()) continue;
            fmt::memory_buffer text;
            append(text, recording, scan);
            out.write({text.data(), text.size()});
            any = true;
        }
        return any;
    };
    const auto grains = folder / (export_name(number, recording.label) + ".xyz");
    const auto contacts = folder / (export_name(number, recording.label) + ".contacts.dump");
    bool any = false;
    replace_own(grains, FileKind::xyz, [&](NewFile& out) { any = write_frames(out, append_grains); });
    if (!any) {
        std::filesystem::remove(grains);
        return 0;
    }
    replace_own(contacts, FileKind::dump, [&](NewFile& out) { write_frames(out, append_contacts); });
    return 2;
}

}  // namespace

int export_xyz(const std::filesystem::path& file_or_folder, const std::filesystem::path& folder,
               const ExportChoice& choice) {
    return export_replicas(file_or_folder, folder, choice, {"OVITO.txt", how_to_look}, export_xyz_replica);
}

}  // namespace mcdem::io
