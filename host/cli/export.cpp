// mcdem export
#include <fmt/format.h>

#include "cli/commands.h"
#include "core/errors.h"
#include "io/vtk.h"

namespace mcdem {
namespace {

struct ExportCommand {
    std::string run, out;
    bool vtk = false;
};

void export_run(const ExportCommand& command) {
    if (!std::filesystem::exists(command.run))
        throw InputError(command.run + ": must be a result folder or file, got nothing there");
    std::error_code error;
    std::filesystem::create_directories(command.out, error);
    if (error) throw RunError(command.out + ": cannot be made: " + error.message());
    const int files = export_vtk(command.run, command.out);
    if (files == 0)
        throw InputError(command.run + ": has no positions to export: run with output.positions = true");
    fmt::print("{} files in {}; {}/README.txt says how to look at them\n", files, command.out, command.out);
}

}  // namespace

void add_export(CLI::App& app, int&) {
    auto* sub = app.add_subcommand("export", "Write grains and contacts for ParaView");
    auto command = std::make_shared<ExportCommand>();
    sub->add_option("RUN", command->run, "Result folder or file")->required();
    sub->add_flag("--vtk", command->vtk, "VTKHDF files, one of grains and one of contacts a scan")
        ->required();
    sub->add_option("--out", command->out, "Folder for the files")->required()->type_name("DIR");
    sub->footer(
        "Needs positions and contacts in the run (output.positions, output.contacts: both on by default).\n"
        "Example:\n"
        "  mcdem export out/small --vtk --out out/paraview");
    sub->callback([command] { export_run(*command); });
}

}  // namespace mcdem
