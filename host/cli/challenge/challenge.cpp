#include "cli/shell/commands.h"

namespace mcdem::inline cli {

void add_challenge(CLI::App& app, int& exit_code) {
    auto* sub =
        app.add_subcommand("challenge", "Test the diagnosis on simulated experiments with hidden effects");
    sub->require_subcommand(1);
    add_python_commands(*sub, exit_code);
    sub->footer(
        "`make` simulates experiments with hidden effects and writes the truth to a separate file; `run`\n"
        "diagnoses the experiments without that file; `score` compares the diagnoses with the truth.\n"
        "Example:\n"
        "  mcdem challenge make scenes/challenge.toml --out out/challenge\n"
        "  mcdem challenge run out/challenge --scene scenes/challenge.toml --library out/library.json --out "
        "out/diagnoses\n"
        "  mcdem challenge score out/challenge out/diagnoses");
}

}  // namespace mcdem::cli
