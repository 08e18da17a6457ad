#include "io/run_packing.h"

#include <fmt/format.h>

#include "core/container.h"
#include "core/errors.h"
#include "core/input_file.h"
#include "core/look.h"
#include "io/results.h"
#include "scene/packing/read_packing.h"

namespace mcdem::inline io {
namespace {

/// The container of a scan; that of a cell at its strain.
StatedBox box_of(const Recording& recording, const Scan& scan, const std::filesystem::path& file) {
    const Box box = deformed(recording.box, scan.strain);
    StatedBox stated;
    stated.where = fmt::format("{}, frame {}", file.string(), scan.frame);
    stated.size = {box.size_x, box.size_y, is_cell(box) ? box.height : scan.plate_z};
    stated.tilt_xy = box.tilt_xy, stated.tilt_xz = box.tilt_xz, stated.tilt_yz = box.tilt_yz;
    stated.shape = box.shape;
    return stated;
}

/// The parts of contact forces across the line from the grain's centre to the contact.
std::vector<TangentialForce> tangential_forces(const Scan& scan) {
    std::vector<TangentialForce> all;
    for (const Contact& contact : scan.contacts) {
        const Vec3 normal = (contact.point - scan.position[contact.grain]).normalized();
        all.push_back({contact.grain, contact.partner, contact.force - contact.force.dot(normal) * normal});
    }
    return all;
}

}  // namespace

FilePacking recorded_packing(const std::filesystem::path& file, std::optional<long> frame) {
    RunReader reader(file);
    const auto& recordings = reader.run().recordings;
    if (recordings.size() != 1)
        throw InputError(
            fmt::format("{}: must hold one replica where it is a packing, got {}: make an experiment of one "
                        "(mcdem experiment from-run), and read its grains.csv",
                        file.string(), recordings.size()));
    const Recording& recording = recordings.front();
    for (std::size_t s = 0; s < recording.scans.size(); ++s) {
        if (frame && recording.scans[s].frame != *frame) continue;
        Scan scan = reader.read_scan(0, s);
        if (!scan.position.empty()) {
            FilePacking packing;
            packing.tangential = tangential_forces(scan);
            packing.box = box_of(recording, scan, file);
            packing.position = std::move(scan.position);
            packing.diameter = recording.diameter;
            packing.species = recording.species;
            packing.species_names = recording.species_names;
            return packing;
        }
        if (frame) break;
    }
    throw InputError(fmt::format("{}: must hold positions of {}, got none: run with output.positions = true",
                                 file.string(), frame ? fmt::format("frame {}", *frame) : "a frame"));
}

FilePacking read_packing_or_run(const std::filesystem::path& file, std::optional<long> frame) {
    constexpr std::string_view hdf5 = "\x89HDF\r\n";
    if (is_file(file) && read_beginning(file, hdf5.size()) == hdf5) return recorded_packing(file, frame);
    return read_packing(file, frame);
}

}  // namespace mcdem::io
