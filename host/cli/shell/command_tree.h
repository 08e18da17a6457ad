// Commands and options of the program as plain values, used to generate the manual and the shell completions.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace mcdem::inline cli {

struct OptionEntry {
    std::vector<std::string> names;    ///< "--out", "-h"; for a positional "SCENE"
    std::string value;                 ///< name of its value, "DIR"; empty for a flag
    std::vector<std::string> choices;  ///< the allowed words, if it takes only these
    std::string text;                  ///< "--out DIR REQUIRED", as in the help
    std::string help;
};

struct CommandEntry {
    std::string path;  ///< "", "run", "experiment check"
    std::string about;
    std::string notes;  ///< text below the options in the help
    std::vector<OptionEntry> options;
    std::vector<OptionEntry> positionals;
    std::vector<std::string> commands;  ///< names of its subcommands
};

/// The program, followed by all commands, each before its subcommands.
std::vector<CommandEntry> command_tree(const CLI::App& app);

/// The entry with `path` followed by `name`.
const CommandEntry& below(const std::vector<CommandEntry>& tree, const std::string& path,
                          const std::string& name);

}  // namespace mcdem::cli
