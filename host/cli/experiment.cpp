// mcdem experiment
#include "cli/experiment.h"

#include "cli/commands.h"

namespace mcdem {

void add_experiment(CLI::App& app, int&) {
    auto* sub = app.add_subcommand("experiment", "Check an experiment's folder, or make one of a simulation");
    sub->require_subcommand(1);
    add_experiment_check(*sub);
    add_experiment_from_run(*sub);
    sub->footer(
        "An experiment's folder is described in host/experiment/README.md.\n"
        "Examples:\n"
        "  mcdem experiment check data/hydrogel\n"
        "  mcdem experiment from-run out/begun --replica mc_dem --out out/reality");
}

}  // namespace mcdem
