// Commands of the Python package (host/python/mcdem/commands).
#include <algorithm>
#include <array>
#include <cstdlib>

#include "cli/shell/commands.h"
#include "cli/shell/python_program.h"
#include "cli/shell/subprocess.h"

namespace mcdem::inline cli {
namespace {

struct PythonCommand {
    const char *name, *about;
};
constexpr std::array python_commands{
    PythonCommand{"table",
                  "Show the top force of each setting, ratios and the scaling law; programmes scan by scan"},
    PythonCommand{"compare", "Compare runs with an experiment or another run: the paper's table"},
    PythonCommand{"figures",
                  "Draw the figures of runs (top force, force distribution, Z, scaling law; others for "
                  "programmes) or of a diagnosis"},
    PythonCommand{"report", "Write an HTML page of runs and diagnoses: charts, packings in 3D, tables"},
    PythonCommand{"export", "Write grains and contacts for ParaView or OVITO"},
};

}  // namespace

bool is_python_command(const std::string& name) {
    return std::ranges::any_of(python_commands, [&](const PythonCommand& one) { return name == one.name; });
}

void add_python_commands(CLI::App& app, int& exit_code) {
    for (const auto& [name, about] : python_commands) {
        auto* sub = app.add_subcommand(name, about)->prefix_command();
        sub->set_help_flag();  // it is the package's
        sub->callback([sub, &exit_code] {
            std::vector<std::string> words{sub->get_name()};
            for (const std::string& word : sub->remaining()) words.push_back(word);
            ::setenv("MCDEM_PROGRAM", this_program().c_str(), 1);
            exit_code = run_python_module("mcdem.run_command", words);
        });
    }
}

}  // namespace mcdem::cli
