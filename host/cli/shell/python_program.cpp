#include "cli/shell/python_program.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "cli/shell/commands.h"
#include "cli/shell/interrupt.h"
#include "cli/shell/subprocess.h"
#include "core/errors.h"
#include "core/look.h"

namespace mcdem::inline cli {
namespace {

namespace fs = std::filesystem;

constexpr int not_started = 126, not_found = 127;              ///< exit codes of env
constexpr auto check_interval = std::chrono::milliseconds(5);  ///< of whether it has ended

std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

std::string interpreter() {
    const std::string chosen = variable("MCDEM_PYTHON");
    if (chosen.find('=') != chosen.npos)
        throw InputError(fmt::format("MCDEM_PYTHON: must be a path without =, got {}", chosen));
    if (!chosen.empty()) return chosen;
    // In a virtual environment the interpreter next to this program, otherwise the system's.
    for (const fs::path& python : {this_program().parent_path() / "python3", fs::path("/usr/bin/python3")})
        if (::access(python.c_str(), X_OK) == 0) return python.string();
    return "python3";
}

/// The folder of the package `mcdem`.
fs::path package_folder() {
    const std::string chosen = variable("MCDEM_PYTHON_FOLDER");
    std::vector<fs::path> folders{chosen};
    if (chosen.empty())
        folders = {this_program().parent_path().parent_path() / "share/mcdem/python", MCDEM_SOURCE_PYTHON};
    for (const fs::path& folder : folders)
        if (is_there(folder / "mcdem/program.py")) return folder;
    std::string looked;
    for (const fs::path& folder : folders) looked += (looked.empty() ? "" : " or ") + folder.string();
    throw RunError(
        fmt::format("the Python package of mcdem is not in {}: install mcdem again, or name its folder by "
                    "MCDEM_PYTHON_FOLDER",
                    looked));
}

ProgramEnd end_of(Subprocess python) {
    const Interrupt interrupt;
    for (bool told = false;;) {
        if (const auto end = python.ended()) return *end;
        if (Interrupt::wanted() && !told) {
            python.send(SIGINT);
            told = true;
        }
        std::this_thread::sleep_for(check_interval);
    }
}

}  // namespace

int run_python_module(const std::string& module, const std::vector<std::string>& arguments) {
    const std::string python = interpreter(), others = variable("PYTHONPATH");
    // A search path with only the package's folder and the user's settings, so that modules in the current
    // folder are not used.
    std::vector<std::string> words{
        "/usr/bin/env",
        "PYTHONPATH=" + package_folder().string() + (others.empty() ? "" : ":" + others),
        "PYTHONSAFEPATH=1",
        "PYTHONDONTWRITEBYTECODE=1",
        python,
        "-m",
        "mcdem.program",
        module};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::fflush(stdout);  // otherwise its output would come first
    const ProgramEnd end = end_of(Subprocess(words));
    if (end.exit_code == not_started || end.exit_code == not_found)
        throw RunError(fmt::format(
            "{}: cannot be started: install python3, or name a Python 3 by MCDEM_PYTHON", python));
    if (end.exit_code >= 0) return end.exit_code;
    if (end.signal == SIGINT || end.signal == SIGTERM) return exit_interrupted;
    throw RunError(fmt::format("{} -m {}: was ended by signal {}", python, module, end.signal));
}

}  // namespace mcdem::cli
