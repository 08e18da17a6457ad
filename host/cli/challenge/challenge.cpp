// mcdem challenge
#include "cli/challenge/challenge.h"

#include "cli/shell/commands.h"

namespace mcdem::inline cli {

void add_challenge(CLI::App& app, int& exit_code) {
    auto* sub =
        app.add_subcommand("challenge", "Test diagnoses on simulated experiments whose effects are withheld");
    sub->require_subcommand(1);
    for (const auto add : {add_challenge_make, add_challenge_run, add_challenge_score}) add(*sub, exit_code);
    sub->footer(
        "`make` draws realities and seals the answers in a file; `run` diagnoses the realities without that "
        "file;\n"
        "`score` opens it and holds the diagnoses against it.\n"
        "Example:\n"
        "  mcdem challenge make scenes/challenge.toml --out out/challenge\n"
        "  mcdem challenge run out/challenge --scene scenes/challenge.toml --library out/library.json --out "
        "out/answers\n"
        "  mcdem challenge score out/challenge out/answers");
}

}  // namespace mcdem::cli
