#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>

#include <algorithm>
#include <iterator>

#include "core/atomic_file.h"
#include "core/container.h"
#include "core/errors.h"
#include "core/make_folder.h"
#include "core/parameters.h"
#include "core/sha256.h"
#include "experiment/experiment.h"
#include "experiment/measurements.h"
#include "experiment/settings.h"

namespace mcdem::inline experiment {
namespace {

// "{}" prints the shortest digits that give the same number when read.

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
            const std::string partner = is_wall(contact.partner)
                                            ? std::string(wall_name(recording.box, wall_of(contact.partner)))
                                            : std::to_string(contact.partner);
            fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{}\n", s, contact.grain,
                           partner, contact.point.x(), contact.point.y(), contact.point.z(),
                           contact.force.x(), contact.force.y(), contact.force.z());
        }
    return fmt::to_string(text);
}

/// Compressed with gzip, without a time stamp.
std::string packed_by_gzip(const std::string& text) {
    constexpr int level = 6, window_of_gzip = 15 + 16, memory = 8;
    z_stream stream{};
    if (deflateInit2(&stream, level, Z_DEFLATED, window_of_gzip, memory, Z_DEFAULT_STRATEGY) != Z_OK)
        throw RunError("zlib: a table cannot be packed");
    std::string packed(deflateBound(&stream, text.size()), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = static_cast<uInt>(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    const int result = deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    if (result != Z_STREAM_END) throw RunError("zlib: a table cannot be packed");
    return packed;
}

/// Tables without rows are not written.
void add_table(std::map<std::string, std::string>& files, const std::string& name,
               const std::vector<std::string>& columns, const std::string& rows, Packed packed) {
    if (rows.empty()) return;
    const std::string text = fmt::format("{}\n", fmt::join(columns, ",")) + rows;
    if (packed == Packed::gzip)
        files[name + ".gz"] = packed_by_gzip(text);
    else
        files[name] = text;
}

void add_plate_table(std::map<std::string, std::string>& files, const Recording& recording, Packed packed) {
    const auto set_force = set_forces(recording);
    const bool has_times = has_programme(recording.parameters);
    const bool sets_force = std::ranges::any_of(set_force, &std::optional<double>::has_value);
    std::vector<std::string> columns = plate_columns;
    if (sets_force) columns.push_back(plate_columns_of_programmes[0]);
    if (has_times) columns.push_back(plate_columns_of_programmes[1]);
    std::string text;
    for (std::size_t s = 0; s < recording.scans.size(); ++s) {
        const Scan& scan = recording.scans[s];
        text +=
            fmt::format("{},{},{},{},{}", s, scan.cycle, name(scan.phase), scan.plate_z, scan.top_force());
        if (sets_force) text += set_force[s] ? fmt::format(",{}", *set_force[s]) : ",";
        if (has_times) text += fmt::format(",{}", scan.time);
        text += '\n';
    }
    add_table(files, "plate.csv", columns, text, packed);
}

}  // namespace

std::map<std::string, std::string> experiment_files(const Experiment& experiment, Packed packed) {
    const Recording& recording = experiment.recording;
    std::map<std::string, std::string> files;
    add_table(files, "contacts.csv", contact_columns, contact_rows(recording), packed);
    add_table(files, "grains.csv", grain_columns, grain_rows(recording), packed);
    add_plate_table(files, recording, packed);
    files["experiment.toml"] = settings_text(experiment);
    return files;
}

std::string sums_text(const std::map<std::string, std::string>& files) {
    std::string text;
    for (const auto& [name, bytes] : files) text += fmt::format("{}  {}\n", Sha256().add(bytes).hex(), name);
    return text;
}

void write_experiment(const std::filesystem::path& folder, const Experiment& experiment, Packed packed) {
    make_folder(folder);
    const auto files = experiment_files(experiment, packed);
    for (const std::string name : {"contacts.csv", "grains.csv", "plate.csv"})
        for (const std::string end : {"", ".gz"})
            if (!files.contains(name + end)) std::filesystem::remove(folder / (name + end));
    // experiment.toml is written last, because it makes the folder an experiment.
    for (const auto& [name, bytes] : files)
        if (name != "experiment.toml") replace_file(folder / name, bytes);
    replace_file(folder / "experiment.toml", files.at("experiment.toml"));
}

}  // namespace mcdem::experiment
