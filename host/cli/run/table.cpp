#include "cli/run/results.h"
#include "cli/shell/commands.h"
#include "cli/shell/standard_streams.h"
#include "core/errors.h"
#include "metrics/programmes.h"
#include "report/run/tables.h"

namespace mcdem::inline cli {
namespace {

struct TableCommand {
    std::vector<std::string> runs;
    std::string over;
    bool markdown = false, csv = false;
};

void print_tables(const TableCommand& command) {
    const auto loaded = load_runs(command.runs, ReadWhat::observables);
    const auto format = command.markdown ? TableFormat::markdown : TableFormat::terminal;
    const auto over = command.over.empty() ? std::nullopt : std::optional(command.over);
    const auto programmes = with_programme(loaded.settings, true);
    const auto strokes = with_programme(loaded.settings, false);
    if (command.csv && !programmes.empty()) {
        if (!strokes.empty())
            throw InputError(
                "--csv: programmes and strokes have different columns; give the runs one by one");
        return print_out("{}", csv_of_scans(programmes));
    }
    for (const TextTable& table : tables_of_scans(programmes)) print_out("{}\n", to_text(table, format));
    if (strokes.empty()) return;
    const auto models = model_table(strokes, over);
    if (command.csv) return print_out("{}", csv_of_models(models, strokes));
    print_out("{}\n", to_text(table_of_models(models), format));
    print_out("{}", to_text(table_of_scaling(strokes), format));
}

}  // namespace

void add_table(CLI::App& app, int&) {
    auto* sub = app.add_subcommand(
        "table", "Show the top force of each setting, ratios and the scaling law; programmes scan by scan");
    auto command = std::make_shared<TableCommand>();
    add_runs_option(*sub, command->runs);
    sub->add_option("--over", command->over, "Label of the setting that ratios refer to (default: mc_dem)")
        ->type_name("LABEL");
    sub->add_flag("--markdown", command->markdown, "Print Markdown");
    sub->add_flag("--csv", command->csv,
                  "Print CSV: top forces and ratios, for programmes scan by scan, with a column for each "
                  "scene key that varies");
    sub->footer(
        "Ratios are paired by packing if replicas start from the same one; ± is the standard error over\n"
        "replicas. *: no replica reached full stroke; the last scan and its displacement are shown.\n"
        "Examples:\n"
        "  mcdem table out/small\n"
        "  mcdem table out/small --over independent --markdown\n"
        "  mcdem table out/small --csv > models.csv");
    sub->callback([command] { print_tables(*command); });
}

}  // namespace mcdem::cli
