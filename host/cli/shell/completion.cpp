// What the completion scripts of the shells ask for (host/python/mcdem/commands/completion).
#include "cli/shell/commands.h"
#include "cli/shell/standard_streams.h"
#include "scene/read/keys.h"

namespace mcdem::inline cli {
namespace {

/// Prints one candidate, if it continues the word.
void offer(const std::string& word, const std::string& candidate, const std::string& description = "") {
    if (!candidate.starts_with(word)) return;
    const std::string line = description.substr(0, description.find('\n'));
    print_out("{}{}{}\n", candidate, line.empty() ? "" : "\t", line);
}

void offer_values(const CLI::Option& option, const std::string& word) {
    const std::string type = option.get_type_name();
    if (type == "DIR") print_out(":folders\n");
    if (type == "KEY=VALUE")
        for (const Key& key : keys()) offer(word, std::string(key.name) + "=");
}

void offer_options(const std::vector<const CLI::Option*>& options, const std::string& word) {
    for (const CLI::Option* option : options) {
        for (const auto& name : option->get_lnames()) offer(word, "--" + name, option->get_description());
        for (const auto& name : option->get_snames()) offer(word, "-" + name, option->get_description());
    }
}

}  // namespace

void print_candidates(const CLI::App& app, std::vector<std::string> words) {
    const std::string word = words.empty() ? "" : words.back();
    if (!words.empty()) words.pop_back();
    const auto chosen = app.get_subcommands(
        [&](const CLI::App* one) { return !words.empty() && one->get_name() == words.front(); });
    const CLI::App* const command = chosen.empty() ? &app : chosen.front();
    const auto options = command->get_options(
        [](const CLI::Option* one) { return !one->get_positional() && !one->get_group().empty(); });
    for (const CLI::Option* option : options)
        if (option->get_items_expected_max() > 0 && !words.empty() && option->check_name(words.back()))
            return offer_values(*option, word);
    if (word.starts_with("-")) return offer_options(options, word);
    for (const CLI::App* one : command->get_subcommands([](const CLI::App*) { return true; }))
        offer(word, one->get_name(), one->get_description());
    if (!command->get_options([](const CLI::Option* one) { return one->get_positional(); }).empty())
        print_out(":files\n");
}

}  // namespace mcdem::cli
