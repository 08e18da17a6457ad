#include "io/export_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/make_folder.h"
#include "core/output_file.h"
#include "core/parameters.h"
#include "core/recording.h"
#include "io/result_folder.h"
#include "io/results.h"

namespace mcdem::inline io {
namespace {

bool has(const std::vector<int>& list, int number) {
    return list.empty() || std::ranges::find(list, number) != list.end();
}

void expect_replicas(const ExportChoice& choice, const Run& run) {
    for (const int number : choice.replicas)
        if (number < 0 || number >= static_cast<int>(run.recordings.size()))
            throw InputError(
                fmt::format("--replica: must be one of 0 to {}, got {}", run.recordings.size() - 1, number));
}

/// A line for each selected replica: its name and every scene key that varies.
std::string list_of_replicas(const ExportChoice& choice, const Run& run) {
    std::string lines;
    const auto keys = keys_that_vary(run.recordings);
    for (std::size_t r = 0; r < run.recordings.size(); ++r) {
        if (!choice.has_replica(r)) continue;
        lines += export_name(r, run.recordings[r].label);
        for (const std::string& key : keys)
            lines += fmt::format("  {} = {}", key, value_of(run.recordings[r].parameters, key));
        lines += "\n";
    }
    return lines;
}

/// Whether a selected replica has a selected scan.
bool has_scans(const std::filesystem::path& run, const ExportChoice& choice) {
    const Run read = read_run(run, ReadWhat::observables);
    for (std::size_t r = 0; r < read.recordings.size(); ++r)
        if (choice.has_replica(r) && std::ranges::any_of(read.recordings[r].scans, [&](const Scan& scan) {
                return choice.has_scan(scan.frame);
            }))
            return true;
    return false;
}

}  // namespace

int export_run(const std::filesystem::path& run, const std::filesystem::path& folder,
               const ExportFormats& formats, const ExportChoice& choice) {
    if (!formats.vtk && !formats.xyz) throw InputError("export: choose a format: vtk, xyz or both");
    result_files(run);  // throws before a folder is created
    const FolderLock lock = open_output_folder(folder);
    const int files = (formats.vtk ? export_vtk(run, folder, choice) : 0) +
                      (formats.xyz ? export_xyz(run, folder, choice) : 0);
    if (files == 0)
        throw InputError(
            has_scans(run, choice)
                ? run.string() + ": has no positions to export: run with output.positions = true"
                : fmt::format("--scan: must be among the scans of {} (column frame of plate.csv), got {}",
                              run.string(), fmt::join(choice.scans, ", ")));
    return files;
}

bool ExportChoice::has_replica(std::size_t number) const { return has(replicas, static_cast<int>(number)); }

bool ExportChoice::has_scan(int frame) const { return has(scans, frame); }

std::string export_name(std::size_t number, const std::string& label) {
    constexpr std::size_t most = 80;  // characters of the label
    std::string words;
    for (const char c : label) {
        const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                           c == '.' || c == '=' || c == '-' || c == '+';
        if (plain)
            words += c;
        else if (!words.empty() && words.back() != '_')
            words += '_';
    }
    words.resize(std::min(words.size(), most));
    while (words.ends_with('_') || words.ends_with('.')) words.pop_back();
    return fmt::format("replica_{:05}{}{}", number, words.empty() ? "" : "_", words);
}

int export_replicas(const std::filesystem::path& file_or_folder, const std::filesystem::path& folder,
                    const ExportChoice& choice, const ExportGuide& guide,
                    const ExportReplica& export_replica) {
    RunReader reader(file_or_folder);
    expect_replicas(choice, reader.run());
    make_folder(folder);
    replace_own(folder / guide.name, FileKind::guide, guide.text + list_of_replicas(choice, reader.run()));
    int files = 0;
    for (std::size_t r = 0; r < reader.run().recordings.size(); ++r)
        if (choice.has_replica(r)) files += export_replica(reader, r, folder, choice);
    return files;
}

std::vector<GrainLoad> grain_loads(const Scan& scan) {
    std::vector<GrainLoad> loads(scan.position.size());
    for (const Contact& contact : scan.contacts) {
        for (const int grain : {contact.grain, contact.partner}) {
            if (is_wall(grain)) continue;
            GrainLoad& load = loads[grain];
            load.contacts += 1;
            load.force_magnitude += contact.force.norm();
        }
        if (is_wall(contact.partner)) loads[contact.grain].wall_force += contact.force;
    }
    return loads;
}

}  // namespace mcdem::io
