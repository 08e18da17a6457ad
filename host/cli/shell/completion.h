// Completion scripts for shells, written from the program's own commands and options.
#pragma once
#include <string>
#include <vector>

#include "cli/shell/command_tree.h"

namespace mcdem::inline cli {

/// `shell` is bash, zsh or fish; `scene_keys` complete what is given as KEY=VALUE.
std::string completion_script(const std::vector<CommandEntry>& tree, const std::string& shell,
                              const std::vector<std::string>& scene_keys);

}  // namespace mcdem::cli
