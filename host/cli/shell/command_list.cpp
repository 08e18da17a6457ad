#include "cli/shell/command_list.h"

#include <algorithm>
#include <set>
#include <sstream>

namespace mcdem::inline cli {

std::vector<ListedCommand> listed_commands() {
    std::istringstream lines(embedded_command_list().at("commands.txt"));
    std::vector<ListedCommand> commands;
    for (std::string name, about; std::getline(lines, name, '\t') && std::getline(lines, about);)
        if (name.find(' ') == name.npos) commands.push_back({name, about});
    return commands;
}

bool is_python_command(const std::string& name) {
    const auto listed = listed_commands();
    return !std::set<std::string>{"devices", "validate", "run"}.contains(name) &&
           std::ranges::find(listed, name, &ListedCommand::name) != listed.end();
}

}  // namespace mcdem::cli
