// mcdem distribute
#include <cstdlib>

#include "cli/shell/commands.h"
#include "cli/shell/python_program.h"
#include "cli/shell/subprocess.h"

namespace mcdem::inline cli {
namespace {

struct DistributeCommand {
    std::string scheduler;
    int tries = 3;
    std::vector<std::string> words;
};

int run(const DistributeCommand& command) {
    ::setenv("MCDEM_PROGRAM", this_program().c_str(), 1);
    std::vector<std::string> words{"--tries", std::to_string(command.tries)};
    if (!command.scheduler.empty()) words.insert(words.end(), {"--scheduler", command.scheduler});
    words.insert(words.end(), command.words.begin(), command.words.end());
    return run_python_module("mcdem.distributed", words);
}

}  // namespace

void add_distribute(CLI::App& app, int& exit_code) {
    auto* sub = app.add_subcommand("distribute", "Compute the parts of a command's work by Dask");
    auto command = std::make_shared<DistributeCommand>();
    sub->add_option(
           "--scheduler", command->scheduler,
           "Address (tcp://..) or file of a Dask scheduler that runs; without it one of this machine, with "
           "a worker for each of its devices")
        ->type_name("ADDRESS");
    sub->add_option("--tries", command->tries, "Of a part that fails")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    sub->prefix_command();
    sub->footer(
        "COMMAND is `run`, `challenge run` or `diagnose`, with its options. Its parts are Dask's tasks: "
        "those of a lost\n"
        "worker are computed again, the dashboard whose address is printed shows how far they are, and the "
        "same\n"
        "command goes on with what is missing. The result is that of one process to the last bit. Needs\n"
        "python3-distributed. From Python: mcdem.distributed (host/python/README.md).\n"
        "Examples:\n"
        "  mcdem distribute run scenes/replicas.toml --out out/replicas\n"
        "  mcdem distribute --scheduler tcp://head:8786 run scenes/replicas.toml --out out/replicas");
    sub->callback([command, sub, &exit_code] {
        command->words = sub->remaining();
        exit_code = run(*command);
    });
}

}  // namespace mcdem::cli
