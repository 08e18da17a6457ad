#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cli/shell/commands.h"
#include "cli/shell/python_program.h"
#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/look.h"
#include "io/result_folder.h"
#include "io/results.h"

namespace mcdem::inline cli {
namespace {

namespace fs = std::filesystem;

struct ExportCommand {
    std::string run, out;
    bool vtk = false, xyz = false;
    std::vector<int> replicas, scans;  ///< empty: all
};

bool chosen(const std::vector<int>& numbers, int number) {
    return numbers.empty() || std::ranges::count(numbers, number) > 0;
}

/// The files of the run, after all that is exported was read once: the Python module relies on its form.
std::vector<fs::path> checked_files(const ExportCommand& command) {
    if (!is_there(command.run))
        throw InputError(command.run + ": must be a result folder or file, got nothing there");
    RunReader reader(command.run);
    const auto& recordings = reader.run().recordings;
    const int count = static_cast<int>(recordings.size());
    for (const int number : command.replicas)
        if (number < 0 || number >= count)
            throw InputError(fmt::format("--replica: must be one of 0 to {}, got {}", count - 1, number));
    bool has_scans = command.scans.empty(), has_positions = false;
    for (int r = 0; r < count; ++r)
        for (std::size_t s = 0; chosen(command.replicas, r) && s < recordings[r].scans.size(); ++s) {
            if (!chosen(command.scans, recordings[r].scans[s].frame)) continue;
            has_scans = true;
            if (!reader.read_scan(r, s).position.empty()) has_positions = true;
        }
    if (!has_scans)
        throw InputError(
            fmt::format("--scan: must be among the scans of {} (column frame of plate.csv), got {}",
                        command.run, fmt::join(command.scans, ", ")));
    if (!has_positions)
        throw InputError(command.run + ": has no positions to export: run with output.positions = true");
    return reader.files();
}

int run_export(const ExportCommand& command) {
    if (!command.vtk && !command.xyz) throw InputError("export: choose a format: vtk, xyz or both");
    const auto files = checked_files(command);
    const FolderLock lock = open_output_folder(command.out);
    for (const fs::path& entry : entries_of(command.out))  // of earlier exports
        if (look_at_itself(entry) != At::link && entry.filename().string().starts_with("replica_"))
            remove_temporaries(entry);
    std::vector<std::string> words;
    if (command.vtk) words.push_back("--vtk");
    if (command.xyz) words.push_back("--xyz");
    for (const int replica : command.replicas) words.push_back(fmt::format("--replica={}", replica));
    for (const int scan : command.scans) words.push_back(fmt::format("--scan={}", scan));
    words.insert(words.end(), {"--", command.out});
    for (const fs::path& file : files) words.push_back(file.string());
    return run_python_module("mcdem.exporting", words);
}

}  // namespace

void add_export(CLI::App& app, int& exit_code) {
    auto* sub = app.add_subcommand("export", "Write grains and contacts for ParaView or OVITO");
    auto command = std::make_shared<ExportCommand>();
    sub->add_option("RUN", command->run, "Result folder or file")->required();
    sub->add_flag("--vtk", command->vtk,
                  "Write VTKHDF files: grains, contacts, forces and walls, one file of each per scan");
    sub->add_flag("--xyz", command->xyz,
                  "Write extended XYZ of the grains and a LAMMPS local dump of the contacts, one file of "
                  "each per replica");
    sub->add_option("--replica", command->replicas, "Numbers of the replicas to export; default: all")
        ->type_name("N");
    sub->add_option("--scan", command->scans,
                    "Numbers of the scans to export (column frame of plate.csv); default: all")
        ->type_name("N");
    sub->add_option("--out", command->out, "Folder for the exported files")->required()->type_name("DIR");
    sub->footer(
        "Needs positions and contacts in the run (output.positions, output.contacts: both on by default), "
        "and "
        "the Python package h5py.\n"
        "Examples:\n"
        "  mcdem export out/small --vtk --out out/paraview\n"
        "  mcdem export out/small --vtk --replica 1 --scan 6 7 --out out/some\n"
        "  mcdem export out/small --xyz --out out/ovito");
    sub->callback([command, &exit_code] { exit_code = run_export(*command); });
}

}  // namespace mcdem::cli
