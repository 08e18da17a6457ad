#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <iterator>
#include <system_error>

#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/make_folder.h"
#include "experiment/experiment.h"
#include "experiment/measurements.h"
#include "experiment/settings.h"

namespace mcdem {
namespace {

// "{}" prints the shortest digits that read back as the same number.

std::string plate_rows(const Recording& recording) {
    fmt::memory_buffer text;
    for (const Scan& scan : recording.scans)
        fmt::format_to(std::back_inserter(text), "{},{},{},{},{}\n", &scan - recording.scans.data(),
                       scan.cycle, name(scan.phase), scan.plate_z, scan.top_force());
    return fmt::to_string(text);
}

std::string grain_rows(const Recording& recording) {
    fmt::memory_buffer text;
    for (std::size_t s = 0; s < recording.scans.size(); ++s) {
        const auto& position = recording.scans[s].position;
        for (std::size_t i = 0; i < position.size(); ++i)
            fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{}\n", s, i, position[i].x(),
                           position[i].y(), position[i].z(), recording.diameter[i]);
    }
    return fmt::to_string(text);
}

std::string contact_rows(const Recording& recording) {
    fmt::memory_buffer text;
    for (std::size_t s = 0; s < recording.scans.size(); ++s)
        for (const Contact& contact : recording.scans[s].contacts) {
            const std::string partner = is_wall(contact.partner) ? std::string(name(wall_of(contact.partner)))
                                                                 : std::to_string(contact.partner);
            fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{}\n", s, contact.grain,
                           partner, contact.point.x(), contact.point.y(), contact.point.z(),
                           contact.force.x(), contact.force.y(), contact.force.z());
        }
    return fmt::to_string(text);
}

/// zlib keeps no time of day in the file.
void write_packed(NewFile& out, const std::string& text) {
    const int descriptor = ::dup(out.descriptor());
    const gzFile packed = descriptor < 0 ? nullptr : gzdopen(descriptor, "wb6");
    if (!packed && descriptor >= 0) ::close(descriptor);
    const bool is_whole = packed && gzfwrite(text.data(), 1, text.size(), packed) == text.size();
    if ((packed && gzclose(packed) != Z_OK) || !is_whole)
        throw RunError(fmt::format("{}: cannot be written: {}", out.place().string(),
                                   std::generic_category().message(errno)));
}

/// Writes the table and removes one of the same name that is packed the other way. No rows: no table.
void write_table(const std::filesystem::path& folder, const std::string& name,
                 const std::vector<std::string>& columns, const std::string& rows, Packed packed) {
    const auto plain = folder / name, gz = folder / (name + ".gz");
    const auto& file = packed == Packed::gzip ? gz : plain;
    const std::string header = fmt::format("{}\n", fmt::join(columns, ","));
    std::filesystem::remove(packed == Packed::gzip ? plain : gz);
    if (rows.empty()) {
        std::filesystem::remove(file);
        return;
    }
    replace_file(file, [&](NewFile& out) {
        if (packed == Packed::gzip) {
            write_packed(out, header + rows);
        } else {
            out.write(header);
            out.write(rows);
        }
    });
}

}  // namespace

void write_experiment(const std::filesystem::path& folder, const Experiment& experiment, Packed packed) {
    make_folder(folder);
    const Recording& recording = experiment.recording;
    write_table(folder, "contacts.csv", contact_columns(), contact_rows(recording), packed);
    write_table(folder, "grains.csv", grain_columns(), grain_rows(recording), packed);
    write_table(folder, "plate.csv", plate_columns(), plate_rows(recording), packed);
    replace_file(folder / "experiment.toml", settings_text(experiment));
}

}  // namespace mcdem
