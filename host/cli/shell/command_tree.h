// The program's commands and options as plain values: what its manual and the shells' completions are written
// from, so that they say what the program does.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace mcdem::inline cli {

struct OptionEntry {
    std::vector<std::string> names;    ///< "--out", "-h"; for a positional "SCENE"
    std::string value;                 ///< what it takes, "DIR"; empty for a flag
    std::vector<std::string> choices;  ///< the words it takes, where these are all
    std::string text;                  ///< "--out DIR REQUIRED", as the help shows it
    std::string help;
};

struct CommandEntry {
    std::string path;  ///< "", "run", "experiment check"
    std::string about;
    std::string notes;  ///< what the help says below the options
    std::vector<OptionEntry> options;
    std::vector<OptionEntry> positionals;
    std::vector<std::string> commands;  ///< names below it
};

/// The program itself, then every command, each before those below it.
std::vector<CommandEntry> command_tree(const CLI::App& app);

/// The entry at `path` and then `name`.
const CommandEntry& below(const std::vector<CommandEntry>& tree, const std::string& path,
                          const std::string& name);

}  // namespace mcdem::cli
