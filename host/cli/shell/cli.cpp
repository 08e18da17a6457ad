#include "cli/shell/cli.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <map>
#include <new>

#include "cl/kernel_cache.h"
#include "cli/shell/command_list.h"
#include "cli/shell/commands.h"
#include "cli/shell/messages.h"
#include "cli/shell/python_program.h"
#include "cli/shell/standard_streams.h"
#include "core/errors.h"
#include "core/stack.h"
#include "core/version.h"

namespace mcdem::inline cli {
namespace {

const char* const about =
    "Simulates dense packings of soft grains with multi-contact forces (MC-DEM) on any OpenCL device.";

const char* const first_steps =
    "First steps:\n"
    "  mcdem devices                                      list the devices\n"
    "  mcdem run scenes/small.toml --out out/small        a first run, takes seconds\n"
    "  mcdem run scenes/compression.toml --out out/first  a compression like the paper's, seven contact "
    "models\n"
    "  mcdem table out/first                              top force of each model\n"
    "  mcdem report out/small --out out/small.html        HTML page with charts and packings\n"
    "  mcdem diagnose --help                              compare a scene with an experiment\n"
    "  mcdem COMMAND --help                               help on a command, with examples\n"
    "\n"
    "Exit codes: 0 success, 1 failure (also if output cannot be written), 2 invalid input, 130 interrupted.\n"
    "To continue after an interruption give the same command again; a plain `mcdem run` also needs "
    "--resume.\n"
    "Environment: MCDEM_DEVICE selects the device if --device is not given.";

/// Reports an error in the command line, and which help to read.
int report_usage(const CLI::App& app, const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    // "A subcommand is required" does not mention an unknown subcommand.
    const auto unknown = chosen.empty() ? app.remaining() : std::vector<std::string>{};
    if (unknown.empty())
        spdlog::error("{}", error.what());
    else
        spdlog::error("there is no {} {}", unknown.front().starts_with('-') ? "option" : "command",
                      unknown.front());
    spdlog::error("`mcdem {}--help` tells more", chosen.empty() ? "" : chosen.front()->get_name() + " ");
    return exit_bad_input;
}

/// Shows default values in the help. Refuses empty paths, which would mean the current folder, or fail only
/// after the work.
void finish_options(CLI::App& command) {
    for (CLI::Option* option : command.get_options()) {
        if (option->get_items_expected_max() == 1) option->capture_default_str();
        if (option->get_single_name() == "out")
            option->check([](const std::string& path) {
                return path.empty() ? std::string("must be a path, got nothing") : std::string();
            });
    }
}

/// `mcdem complete -- WORD..`, which the completion scripts of the shells start.
int complete(const CLI::App& app, std::vector<std::string> words) {
    words.erase(words.begin(), words.begin() + (words.size() > 1 && words[1] == "--" ? 2 : 1));
    if (words.size() < 2 || !is_python_command(words.front())) {
        print_candidates(app, words);
        return exit_done;
    }
    words.insert(words.begin(), "complete");
    return run_python_module("mcdem.run_command", words);
}

/// Commands of earlier versions, and what to do instead.
void expect_not_replaced(const std::string& name) {
    const char* const remedy =
        name == "verify"   ? "every command checks the tables that it reads; `sha256sum --check SHA256SUMS` "
                             "checks the files of an experiment"
        : name == "manual" ? "`mcdem COMMAND --help` shows the same text"
                           : nullptr;
    if (remedy) throw InputError(fmt::format("{} is no command any more: {}", name, remedy));
}

/// Adds all listed commands. Those of the Python package have only their texts here.
void add_commands(CLI::App& app, int& exit_code) {
    const std::map<std::string, void (*)(CLI::App&, int&)> own{
        {"devices", add_devices}, {"validate", add_validate}, {"run", add_run}};
    for (const auto& [name, about] : listed_commands()) {
        CLI::App* const command = app.add_subcommand(name, about);
        if (!own.contains(name)) continue;
        own.at(name)(*command, exit_code);
        finish_options(*command);
    }
}

int command_line(int argc, const char* const* argv) {
    const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
    const std::string first = words.empty() ? "" : words.front();
    if (is_python_command(first)) return run_python_module("mcdem.run_command", words);
    expect_not_replaced(first);
    CLI::App app(about, "mcdem");
    app.footer(first_steps);
    app.require_subcommand(1);
    app.set_version_flag("--version", std::string("mcdem ") + version_text);
    int exit_code = exit_done;
    add_commands(app, exit_code);
    try {
        if (first == "complete")
            exit_code = complete(app, words);
        else
            app.parse(argc, argv);
        return exit_code;
    } catch (const CLI::ParseError& error) {
        return error.get_exit_code() == 0 ? app.exit(error) : report_usage(app, error);
    }
}

constexpr char hint[] =
    "mcdem: ended by a defect of the program or of the OpenCL driver. If it happens again, remove the "
    "compiled kernels (folder POCL_CACHE_DIR, ~/.cache/pocl/kcache or mcdem-kernels-.. in /tmp), which may "
    "be damaged; they are compiled again. Continue a run with --resume.\n";

void say_hint(int signal) {
    const ssize_t written = write(STDERR_FILENO, hint, sizeof hint - 1);
    (void)written;
    raise(signal);  // default action again because of SA_RESETHAND
}

/// Installs handlers that print the hint for signals of crashes, unless another handler is installed. PoCL's
/// compiler installs some, so call this again after OpenCL has started.
void hint_at_crashes() {
    for (const int signal : {SIGABRT, SIGBUS, SIGSEGV, SIGILL, SIGFPE}) {
        struct sigaction before {};
        const bool is_free = sigaction(signal, nullptr, &before) == 0 && before.sa_handler == SIG_DFL;
        if (!is_free && signal != SIGABRT)
            continue;  // handler of a sanitizer, or one that continues with the previous handler
        struct sigaction action {};
        action.sa_handler = say_hint;
        action.sa_flags = static_cast<int>(SA_RESETHAND);
        sigaction(signal, &action, nullptr);
    }
}

}  // namespace

int run_cli(int argc, const char* const* argv) {
    try {
        set_up_streams();
        set_up_messages();
    } catch (const std::bad_alloc&) {  // no memory for a message
        std::fputs("mcdem: not enough memory\n", stderr);
        return exit_failed;
    }
    try {
        expect_enough_stack();
        hint_at_crashes();
        opencl_started = hint_at_crashes;
        kernel_cache_refused = [](const std::string& why) { spdlog::warn("{}", why); };
        return exit_code_of_output(command_line(argc, argv));
    } catch (const std::exception& error) {
        return report_error(error);
    }
}

}  // namespace mcdem::cli
