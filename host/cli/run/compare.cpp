// mcdem compare and mcdem figures: comparison of runs with a reference as numbers and figures.
#include "cli/run/figures.h"
#include "cli/run/report_sources.h"
#include "cli/shell/commands.h"
#include "cli/shell/standard_streams.h"
#include "core/errors.h"
#include "io/result_folder.h"
#include "report/diagnosis/diagnosis_values.h"
#include "report/run/tables.h"

namespace mcdem::inline cli {
namespace {

struct CompareCommand {
    std::vector<std::string> runs;
    ReferenceOptions reference;
    std::string out;
    FigureOptions figures;
    bool markdown = false;
};

void print_paths(const std::vector<std::filesystem::path>& figures, const std::string& folder) {
    if (figures.empty()) throw RunError(folder + ": no figures were drawn");
    for (const auto& figure : figures) print_out("{}\n", figure.string());
}

void print_comparison(const CompareCommand& command) {
    const auto reference = load_reference(command.reference, ReadWhat::contacts);
    const auto loaded = load_runs(command.runs, ReadWhat::contacts);
    std::optional<FolderLock> lock;
    if (!command.out.empty()) lock.emplace(open_output_folder(command.out));
    FigureOptions options = command.figures;
    for (const auto& setting : loaded.settings)
        options.comparisons.push_back(compare(setting, reference.setting.replicas, options.touch_force));
    print_out("against {}\n\n{}", reference.setting.label,
              to_text(table_of_comparisons(options.comparisons),
                      command.markdown ? TableFormat::markdown : TableFormat::terminal));
    if (command.out.empty()) return;
    print_out("\n");
    print_paths(draw_runs(command.out, loaded.settings, reference.setting, options), command.out);
}

void print_figures_of_diagnosis(const CompareCommand& command, const std::filesystem::path& file) {
    if (command.runs.size() > 1)
        throw InputError(file.string() + ": cannot be combined with other runs or diagnoses");
    const Diagnosis diagnosis = read_diagnosis(file);
    const FolderLock lock = open_output_folder(command.out);
    print_paths(draw_figures(command.out, diagnosis_figure_values(diagnosis)), command.out);
}

void print_figures(const CompareCommand& command) {
    for (const auto& source : command.runs)
        if (const auto file = diagnosis_file(source)) return print_figures_of_diagnosis(command, *file);
    const auto loaded = load_runs(command.runs, ReadWhat::contacts);
    std::optional<LoadedReference> reference;
    std::optional<Setting> setting;
    if (!command.reference.paths.empty()) {
        reference = load_reference(command.reference, ReadWhat::contacts);
        setting = reference->setting;
    }
    const FolderLock lock = open_output_folder(command.out);
    print_paths(draw_runs(command.out, loaded.settings, setting, command.figures), command.out);
}

}  // namespace

void add_compare(CLI::App& app, int&) {
    auto* sub =
        app.add_subcommand("compare", "Compare runs with an experiment or another run: the paper's table");
    auto command = std::make_shared<CompareCommand>();
    add_runs_option(*sub, command->runs);
    add_reference_options(*sub, command->reference, "--against",
                          "Experiment folder or run; several are used together");
    sub->get_option("--against")->required();
    sub->add_option("--out", command->out, "Folder for the four figures; without it no figures are drawn")
        ->type_name("DIR");
    sub->add_option("--touch-force", command->figures.touch_force,
                    "For errf, use only displacements at which the reference's top force is above this [N]")
        ->type_name("N")
        ->check(at_least_zero());
    add_figure_options(*sub, command->figures);
    sub->add_flag("--markdown", command->markdown, "Print Markdown");
    sub->footer(
        "Rtop: top force at maximum compression over the reference's. errf: RMS error of the top force.\n"
        "errZ: RMS error of the coordination number, contacts below tau ignored. bhat: distance of the\n"
        "distributions of contact forces. An experiment folder is described in host/experiment/README.md.\n"
        "Examples (DIR: your experiment folder):\n"
        "  mcdem compare out/first --against DIR --discard 5 --out out/comparison\n"
        "  mcdem compare out/small --against out/small --setting mc_dem");
    sub->callback([command] { print_comparison(*command); });
}

void add_figures(CLI::App& app, int&) {
    auto* sub = app.add_subcommand("figures",
                                   "Draw the figures of runs (top force, force distribution, Z, scaling law; "
                                   "others for programmes) or of a diagnosis");
    auto command = std::make_shared<CompareCommand>();
    sub->add_option("RUN|DIAGNOSIS", command->runs,
                    "Result folders or files, or the folder of a diagnosis or its diagnosis.json")
        ->required();
    sub->add_option("--out", command->out, "Folder for the figures")->required()->type_name("DIR");
    add_reference_options(*sub, command->reference, "--against",
                          "Experiment folder or run, drawn as points; several are combined");
    add_figure_options(*sub, command->figures);
    sub->footer(
        "PDF, PNG and SVG, 86 or 178 mm wide, without titles. Runs: top force, force distribution at one "
        "plate\n"
        "displacement, Z without weak contacts, scaling law; programmes: forces, stresses and strains "
        "against\n"
        "each other and against time. Diagnosis: location of the gap, candidate effects, gap reduction.\n"
        "The values are in figures.json; the Python package mcdem.figures has one function per figure.\n"
        "Examples:\n"
        "  mcdem figures out/small --out out/figures\n"
        "  mcdem figures out/small --out out/figures --against out/small --setting mc_dem");
    sub->callback([command] { print_figures(*command); });
}

}  // namespace mcdem::cli
