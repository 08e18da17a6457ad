#include "cli/shell/cli.h"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <initializer_list>
#include <new>

#include "cl/kernel_cache.h"
#include "cli/shell/commands.h"
#include "cli/shell/messages.h"
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
    std::string command = "mcdem";
    const CLI::App* last = &app;
    while (!last->get_subcommands().empty()) {
        last = last->get_subcommands().front();
        command += " " + last->get_name();
    }
    // "A subcommand is required" does not mention an unknown subcommand.
    const auto unknown =
        last->get_require_subcommand_min() > 0 ? app.remaining(true) : std::vector<std::string>{};
    if (unknown.empty())
        spdlog::error("{}", error.what());
    else
        spdlog::error("there is no {} {}", unknown.front().starts_with('-') ? "option" : "command",
                      unknown.front());
    spdlog::error("`{} --help` tells more", command);
    return exit_bad_input;
}

/// Shows default values in the help. Refuses empty paths, which would mean the current folder, or fail only
/// after the work.
void finish_options(CLI::App& app) {
    for (CLI::Option* option : app.get_options()) {
        if (option->get_items_expected_max() == 1) option->capture_default_str();
        if (option->get_single_name() == "out")
            option->check([](const std::string& path) {
                return path.empty() ? std::string("must be a path, got nothing") : std::string();
            });
    }
    for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        finish_options(*command);
}

/// Commands of earlier versions.
void add_replaced(CLI::App& app) {
    for (const auto& [name, remedy] : {std::pair{"verify",
                                                 "every command checks the tables that it reads; `sha256sum "
                                                 "--check SHA256SUMS` checks the files "
                                                 "of an experiment"},
                                       {"manual", "`mcdem COMMAND --help` shows the same text"}}) {
        auto* command = app.add_subcommand(name)->group("")->allow_extras();
        command->callback([name = name, remedy = remedy] {
            throw InputError(fmt::format("{} is no command any more: {}", name, remedy));
        });
    }
}

int command_line(int argc, const char* const* argv) {
    CLI::App app(about, "mcdem");
    app.footer(first_steps);
    app.require_subcommand(1);
    app.set_version_flag("--version", std::string("mcdem ") + version_text);
    int exit_code = exit_done;
    for (const auto add :
         {add_devices, add_validate, add_run, add_distribute, add_python_commands, add_completion})
        add(app, exit_code);
    add_replaced(app);
    finish_options(app);
    try {
        app.parse(argc, argv);
        return exit_code;
    } catch (const CLI::ParseError& error) {
        return error.get_exit_code() == 0 ? app.exit(error) : report_usage(app, error);
    }
}

constexpr char hint[] =
    "mcdem: ended by a defect of the program or of the OpenCL driver. If it happens again, remove the "
    "compiled kernels (folder POCL_CACHE_DIR, ~/.cache/pocl/kcache or mcdem-kernels-.. in /tmp), which may "
    "be "
    "damaged; they are compiled again. Continue a run with --resume.\n";

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
