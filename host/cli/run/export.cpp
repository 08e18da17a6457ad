#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/shell/commands.h"
#include "cli/shell/standard_streams.h"
#include "io/export_run.h"

namespace mcdem::inline cli {
namespace {

struct ExportCommand {
    std::string run, out;
    ExportFormats formats;
    ExportChoice choice;
};

void run_export(const ExportCommand& command) {
    const int files = export_run(command.run, command.out, command.formats, command.choice);
    std::vector<std::string> guides;
    if (command.formats.vtk) guides.push_back(command.out + "/README.txt");
    if (command.formats.xyz) guides.push_back(command.out + "/OVITO.txt");
    print_out("{} files in {}; how to view them: {}\n", files, command.out, fmt::join(guides, ", "));
}

}  // namespace

void add_export(CLI::App& app, int&) {
    auto* sub = app.add_subcommand("export", "Write grains and contacts for ParaView or OVITO");
    auto command = std::make_shared<ExportCommand>();
    sub->add_option("RUN", command->run, "Result folder or file")->required();
    sub->add_flag("--vtk", command->formats.vtk,
                  "Write VTKHDF files: grains, contacts, forces and walls, one file of each per scan");
    sub->add_flag("--xyz", command->formats.xyz,
                  "Write extended XYZ of the grains and a LAMMPS local dump of the contacts, one file of "
                  "each per replica");
    sub->add_option("--replica", command->choice.replicas, "Numbers of the replicas to export; default: all")
        ->type_name("N");
    sub->add_option("--scan", command->choice.scans,
                    "Numbers of the scans to export (column frame of plate.csv); default: all")
        ->type_name("N");
    sub->add_option("--out", command->out, "Folder for the exported files")->required()->type_name("DIR");
    sub->footer(
        "Needs positions and contacts in the run (output.positions, output.contacts: both on by default).\n"
        "Examples:\n"
        "  mcdem export out/small --vtk --out out/paraview\n"
        "  mcdem export out/small --vtk --replica 1 --scan 6 7 --out out/some\n"
        "  mcdem export out/small --xyz --out out/ovito");
    sub->callback([command] { run_export(*command); });
}

}  // namespace mcdem::cli
