#include <fmt/format.h>

#include "cli/run/figures.h"
#include "cli/run/report_sources.h"
#include "cli/run/results.h"
#include "cli/shell/commands.h"
#include "cli/shell/messages.h"
#include "cli/shell/standard_streams.h"
#include "core/errors.h"
#include "core/make_folder.h"
#include "core/output_file.h"
#include "report/diagnosis/diagnosis_page.h"
#include "report/page/page.h"
#include "report/run/run_page.h"

namespace mcdem::inline cli {
namespace {

struct ReportCommand {
    std::vector<std::string> sources;
    std::string out;
    ReferenceOptions reference;
    FigureOptions figures;
    PackingLimits limits;
};

void add_all_runs(Page& page, const std::vector<std::string>& paths, const ReportCommand& command) {
    const auto loaded = load_runs(paths, ReadWhat::contacts);
    std::optional<LoadedReference> reference;
    if (!command.reference.paths.empty()) reference = load_reference(command.reference, ReadWhat::contacts);
    RunsOnPage runs{.origins = origins_of(paths, loaded),
                    .settings = loaded.settings,
                    .reference = reference ? std::optional(reference->setting) : std::nullopt,
                    .figures = command.figures,
                    .packings = {},
                    .left_out = {},
                    .limits = command.limits};
    add_packings(paths, loaded, runs);
    for (const auto& note : runs.left_out) spdlog::info("{}", note);
    add_runs(page, runs);
}

int write_report(const ReportCommand& command) {
    expect_replaceable(command.out, FileKind::page);
    make_folder_of(command.out);
    packed_plotting_library();  // throws before minutes of reading if it is missing
    std::vector<std::string> runs;
    std::vector<std::pair<std::string, Diagnosis>> diagnoses;
    for (const auto& source : command.sources)
        if (const auto file = diagnosis_file(source))
            diagnoses.emplace_back(source, read_diagnosis(*file));
        else
            runs.push_back(source);
    if (runs.empty() && !command.reference.paths.empty())
        throw InputError("--against: needs a run to compare with it, got diagnoses only");
    Page page("mcdem report: " + command.sources.front() +
              (command.sources.size() > 1 ? fmt::format(" and {} more", command.sources.size() - 1) : ""));
    if (!runs.empty()) add_all_runs(page, runs, command);
    for (const auto& [path, diagnosis] : diagnoses) add_diagnosis(page, diagnosis, path);
    write_page(page, command.out);
    print_out("{}\n", command.out);
    return exit_done;
}

}  // namespace

void add_report(CLI::App& app, int& exit_code) {
    auto* sub = app.add_subcommand(
        "report", "Write an HTML page of runs and diagnoses: charts, packings in 3D, tables");
    auto command = std::make_shared<ReportCommand>();
    sub->add_option("RUN|DIAGNOSIS", command->sources,
                    "Result folders or files, of finished or running simulations, and diagnosis folders")
        ->required();
    sub->add_option("--out", command->out, "HTML file to write")->required()->type_name("FILE");
    add_reference_options(*sub, command->reference, "--against",
                          "Experiment folder or run to compare the runs with; several are used together");
    add_figure_options(*sub, command->figures);
    sub->add_option(
           "--scans", command->limits.scans,
           "Maximum number of scans of a packing shown in 3D; default: as many as fit into about 3 MB")
        ->type_name("N")
        ->check(CLI::Range(1, 100000));
    sub->footer(
        "The page is one file and needs no network. It shows top force, force distribution, coordination "
        "number and\n"
        "scaling law as interactive charts, the packing with its force chains and a slider over scans, the "
        "results of\n"
        "diagnoses, the metrics, and the scenes with versions and hashes.\n"
        "The first replica of every setting is shown in 3D. Charts need a browser of 2023 or later.\n"
        "Examples:\n"
        "  mcdem report out/small --out out/small.html\n"
        "  mcdem report out/small out/diagnosis --out out/both.html --against out/measured");
    sub->callback([command, &exit_code] { exit_code = write_report(*command); });
}

}  // namespace mcdem::cli
