
#include "cli/shell/commands.h"
#include "cli/shell/python_program.h"
#include "cli/shell/subprocess.h"
#include "core/errors.h"

namespace mcdem::inline cli {
namespace {

struct DistributeCommand {
    std::string scheduler;
    int tries = 3;
    std::vector<std::string> words;
};

int run(const DistributeCommand& command) {
    if (command.words.empty())
        throw InputError("a command is needed: run, challenge run or diagnose, with its options");
    std::vector<std::string> words{std::to_string(command.tries), command.scheduler};
    words.insert(words.end(), command.words.begin(), command.words.end());
    return run_python_module("mcdem.distributed", words);
}

}  // namespace

void add_distribute(CLI::App& app, int& exit_code) {
    auto* sub = app.add_subcommand(
        "distribute", "Compute the parts of a command's work on the devices of this machine, or with Dask");
    auto command = std::make_shared<DistributeCommand>();
    sub->add_option("--scheduler", command->scheduler,
                    "Address (tls://.., tcp://..) or file of a running Dask scheduler, which needs "
                    "python3-distributed; default: one process at a time on each device of this machine")
        ->type_name("ADDRESS");
    sub->add_option("--tries", command->tries, "Number of attempts for a part that fails")
        ->check(CLI::Range(1, 100));
    sub->prefix_command();
    sub->footer(
        "COMMAND is `run`, `challenge run` or `diagnose`, with its options. Its parts become processes of "
        "this machine, or\n"
        "tasks of the Dask scheduler that --scheduler names. A lost part is computed again, and the same "
        "command continues\n"
        "with what is missing. The result equals that of one process bit for bit. Everybody who reaches a "
        "scheduler can run\n"
        "code on its workers: protect it by TLS (host/ensemble/README.md). From Python: mcdem.distributed "
        "(host/python/README.md).\n"
        "Examples:\n"
        "  mcdem distribute run scenes/replicas.toml --out out/replicas\n"
        "  mcdem distribute --scheduler tls://head:8786 run scenes/replicas.toml --out out/replicas");
    sub->callback([command, sub, &exit_code] {
        command->words = sub->remaining();
        exit_code = run(*command);
    });
}

}  // namespace mcdem::cli
