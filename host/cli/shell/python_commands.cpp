// Commands of the Python package (host/python/mcdem/commands).
#include <algorithm>
#include <array>

#include "cli/shell/commands.h"
#include "cli/shell/python_program.h"

namespace mcdem::inline cli {
namespace {

struct PythonCommand {
    std::string command, name, about;  ///< `command`: of which it is a subcommand; empty: of the program
};
const std::array python_commands{
    PythonCommand{"", "table",
                  "Show the top force of each setting, ratios and the scaling law; programmes scan by scan"},
    PythonCommand{"", "compare", "Compare runs with an experiment or another run: the paper's table"},
    PythonCommand{"", "figures",
                  "Draw the figures of runs (top force, force distribution, Z, scaling law; others for "
                  "programmes) or of a diagnosis"},
    PythonCommand{"", "report", "Write an HTML page of runs and diagnoses: charts, packings in 3D, tables"},
    PythonCommand{"", "export", "Write grains and contacts for ParaView or OVITO"},
    PythonCommand{"", "diagnose",
                  "Find where a simulation and an experiment differ, and which effect is consistent with the "
                  "difference"},
    PythonCommand{"", "calibrate",
                  "Fit gamma of MC-DEM, or E of another model, to the top force of an experiment"},
    PythonCommand{"", "converge",
                  "Measure how plate speed, inertia, time step and settling change a scene's results"},
    PythonCommand{"experiment", "check",
                  "Report which data an experiment contains, which are missing and which are suspicious"},
    PythonCommand{"experiment", "import",
                  "Make an experiment from the tables of a laboratory or another program"},
    PythonCommand{"experiment", "from-run", "Write a simulation as an experiment with measurement errors"},
    PythonCommand{"challenge", "make",
                  "Simulate experiments with hidden effects, and write the truth to a separate file"},
    PythonCommand{"challenge", "run", "Diagnose every experiment of a challenge"},
    PythonCommand{"challenge", "score", "Compare the diagnoses with the truth"},
};

/// A command that has subcommands only.
struct Group {
    const char *name, *about, *footer;
};
const std::array groups{
    Group{"experiment", "Check an experiment folder, or make one from tables or from a simulation",
          "An experiment's folder is described in host/experiment/README.md.\n"
          "Examples:\n"
          "  mcdem experiment import data/plate.txt data/grains.txt --set 'box.size=[0.165, 0.166]' --out "
          "out/lab\n"
          "  mcdem experiment check out/lab\n"
          "  mcdem experiment from-run out/begun --replica mc_dem --out out/measured"},
    Group{
        "challenge", "Test the diagnosis on simulated experiments with hidden effects",
        "`make` simulates experiments with hidden effects and writes the truth to a separate file; `run`\n"
        "diagnoses the experiments without that file; `score` compares the diagnoses with the truth.\n"
        "Example:\n"
        "  mcdem challenge make scenes/challenge.toml --out out/challenge\n"
        "  mcdem challenge run out/challenge --scene scenes/challenge.toml --library out/library.json --out "
        "out/diagnoses\n"
        "  mcdem challenge score out/challenge out/diagnoses"},
};

void add_commands_of(const std::string& above, CLI::App& app, int& exit_code) {
    for (const PythonCommand& one : python_commands) {
        if (one.command != above) continue;
        auto* sub = app.add_subcommand(one.name, one.about)->prefix_command();
        sub->set_help_flag();  // it is the package's
        sub->callback([sub, above, &exit_code] {
            std::vector<std::string> words{sub->get_name()};
            if (!above.empty()) words.insert(words.begin(), above);
            for (const std::string& word : sub->remaining()) words.push_back(word);
            exit_code = run_python_module("mcdem.run_command", words);
        });
    }
}

}  // namespace

bool is_python_command(const std::vector<std::string>& words) {
    return std::ranges::any_of(python_commands, [&](const PythonCommand& one) {
        if (one.command.empty()) return words.front() == one.name;
        return words.size() > 2 && words[0] == one.command && words[1] == one.name;
    });
}

void add_python_commands(CLI::App& app, int& exit_code) {
    add_commands_of("", app, exit_code);
    for (const Group& group : groups) {
        auto* sub = app.add_subcommand(group.name, group.about);
        sub->require_subcommand(1);
        sub->footer(group.footer);
        add_commands_of(group.name, *sub, exit_code);
    }
}

}  // namespace mcdem::cli
