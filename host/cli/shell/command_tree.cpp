#include "cli/shell/command_tree.h"

#include <algorithm>
#include <sstream>

namespace mcdem::inline cli {
namespace {

/// Choices in the type name of a CLI11 option: "TEXT:{bash,zsh,fish}".
std::vector<std::string> choices_of(const std::string& type) {
    const auto from = type.find('{'), to = type.find('}');
    if (from == type.npos || to == type.npos) return {};
    std::stringstream list(type.substr(from + 1, to - from - 1));
    std::vector<std::string> words;
    for (std::string word; std::getline(list, word, ',');) words.push_back(word);
    return words;
}

OptionEntry entry_of(const CLI::Option& option, const CLI::Formatter& format) {
    OptionEntry entry;
    const bool positional = option.get_positional();
    if (positional) entry.names.push_back(option.get_name(true));
    for (const auto& name : option.get_lnames()) entry.names.push_back("--" + name);
    for (const auto& name : option.get_snames()) entry.names.push_back("-" + name);
    if (option.get_items_expected_max() > 0) {
        entry.value = option.get_type_name();
        entry.choices = choices_of(entry.value);
    }
    entry.text = format.make_option_name(&option, positional) + format.make_option_opts(&option);
    entry.help = format.make_option_desc(&option);
    return entry;
}

void append(std::vector<CommandEntry>& tree, const CLI::App& app, const std::string& path) {
    const CLI::Formatter format;
    CommandEntry entry{path, app.get_description(), app.get_footer(), {}, {}, {}};
    for (const CLI::Option* option : app.get_options())
        (option->get_positional() ? entry.positionals : entry.options).push_back(entry_of(*option, format));
    const auto commands = app.get_subcommands([](const CLI::App* one) { return !one->get_group().empty(); });
    for (const CLI::App* command : commands) entry.commands.push_back(command->get_name());
    tree.push_back(std::move(entry));
    for (const CLI::App* command : commands)
        append(tree, *command, path.empty() ? command->get_name() : path + " " + command->get_name());
}

}  // namespace

std::vector<CommandEntry> command_tree(const CLI::App& app) {
    std::vector<CommandEntry> tree;
    append(tree, app, "");
    return tree;
}

const CommandEntry& below(const std::vector<CommandEntry>& tree, const std::string& path,
                          const std::string& name) {
    return *std::ranges::find(tree, path.empty() ? name : path + " " + name, &CommandEntry::path);
}

}  // namespace mcdem::cli
