#include <fmt/format.h>

#include "cli/shell/commands.h"
#include "cli/shell/python_program.h"

namespace mcdem::inline cli {
namespace {

struct ExportCommand {
    std::string run, out;
    bool vtk = false, xyz = false;
    std::vector<int> replicas, scans;
};

int run_export(const ExportCommand& command) {
    std::vector<std::string> words;
    if (command.vtk) words.push_back("--vtk");
    if (command.xyz) words.push_back("--xyz");
    for (const int replica : command.replicas) words.push_back(fmt::format("--replica={}", replica));
    for (const int scan : command.scans) words.push_back(fmt::format("--scan={}", scan));
    words.insert(words.end(), {"--", command.run, command.out});
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
        "Needs positions and contacts in the run (output.positions, output.contacts: both on by default).\n"
        "Examples:\n"
        "  mcdem export out/small --vtk --out out/paraview\n"
        "  mcdem export out/small --vtk --replica 1 --scan 6 7 --out out/some\n"
        "  mcdem export out/small --xyz --out out/ovito");
    sub->callback([command, &exit_code] { exit_code = run_export(*command); });
}

}  // namespace mcdem::cli
