// The commands and what they do (host/python/mcdem/commands/commands.txt), embedded at build time.
#pragma once
#include <map>
#include <string>
#include <vector>

namespace mcdem::inline cli {

/// File name -> content.
const std::map<std::string, std::string>& embedded_command_list();

struct ListedCommand {
    std::string name, about;
};

/// In the order of the help. Of commands of two words (`experiment check`) only the first word is listed.
std::vector<ListedCommand> listed_commands();

/// Whether the Python package runs this command.
bool is_python_command(const std::string& name);

}  // namespace mcdem::cli
