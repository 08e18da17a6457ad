// mcdem export
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/shell/commands.h"
#include "cli/shell/standard_streams.h"
#include "core/errors.h"
#include "io/output_folder.h"
#include "io/result_folder.h"
#include "io/vtk.h"
#include "io/xyz.h"

namespace mcdem::inline cli {
namespace {

struct ExportCommand {
    std::string run, out;
    bool vtk = false, xyz = false;
};

void export_run(const ExportCommand& command) {
    if (!command.vtk && !command.xyz)
        throw InputError("export: must be told what to write, with --vtk, --xyz or both");
    if (!std::filesystem::exists(command.run))
        throw InputError(command.run + ": must be a result folder or file, got nothing there");
    result_files(command.run);  // said before a folder is made where there are none
    const FolderLock lock = open_output_folder(command.out);
    int files = 0;
    if (command.vtk) files += export_vtk(command.run, command.out);
    if (command.xyz) files += export_xyz(command.run, command.out);
    if (files == 0)
        throw InputError(command.run + ": has no positions to export: run with output.positions = true");
    std::vector<std::string> guides;
    if (command.vtk) guides.push_back(command.out + "/README.txt");
    if (command.xyz) guides.push_back(command.out + "/OVITO.txt");
    print_out("{} files in {}; {} says how to look at them\n", files, command.out, fmt::join(guides, ", "));
}

}  // namespace

void add_export(CLI::App& app, int&) {
    auto* sub = app.add_subcommand("export", "Write grains and contacts for ParaView or OVITO");
    auto command = std::make_shared<ExportCommand>();
    sub->add_option("RUN", command->run, "Result folder or file")->required();
    sub->add_flag("--vtk", command->vtk, "VTKHDF files, one of grains and one of contacts a scan");
    sub->add_flag("--xyz", command->xyz,
                  "Extended XYZ of the grains and LAMMPS dump local of the contacts, one of each a replica");
    sub->add_option("--out", command->out, "Folder for the files")->required()->type_name("DIR");
    sub->footer(
        "Needs positions and contacts in the run (output.positions, output.contacts: both on by default).\n"
        "Examples:\n"
        "  mcdem export out/small --vtk --out out/paraview\n"
        "  mcdem export out/small --xyz --out out/ovito");
    sub->callback([command] { export_run(*command); });
}

}  // namespace mcdem::cli
