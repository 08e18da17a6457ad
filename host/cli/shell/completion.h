// Completion scripts for shells, generated from the program's commands and options.
#pragma once
#include <string>
#include <vector>

#include "cli/shell/command_tree.h"

namespace mcdem::inline cli {

/// `shell` is bash, zsh or fish; `scene_keys` complete options of the form KEY=VALUE.
std::string completion_script(const std::vector<CommandEntry>& tree, const std::string& shell,
                              const std::vector<std::string>& scene_keys);

}  // namespace mcdem::cli
