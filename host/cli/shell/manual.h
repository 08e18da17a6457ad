// Manual pages, generated from the program's help.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "cli/shell/command_tree.h"

namespace mcdem::inline cli {

/// One page per command; roff text by file name: "mcdem.1", "mcdem-experiment-check.1".
std::map<std::string, std::string> manual_pages(const std::vector<CommandEntry>& tree,
                                                const std::string& version);

}  // namespace mcdem::cli
