// mcdem completion: scripts for shells. They ask the program itself what can follow (the hidden command
// `complete`).
#include <fmt/format.h>

#include <sstream>

#include "cli/shell/commands.h"
#include "cli/shell/python_program.h"
#include "cli/shell/standard_streams.h"
#include "scene/read/keys.h"

namespace mcdem::inline cli {
namespace {

/// The subcommands that the help lists.
std::vector<const CLI::App*> listed_commands(const CLI::App& command) {
    return command.get_subcommands([](const CLI::App* one) { return !one->get_group().empty(); });
}

/// Prints one candidate, if it continues the word: `CANDIDATE`, or `CANDIDATE<tab>DESCRIPTION`.
void offer(const std::string& word, const std::string& candidate, const std::string& description = "") {
    if (!candidate.starts_with(word)) return;
    const std::string line = description.substr(0, description.find('\n'));
    print_out("{}{}{}\n", candidate, line.empty() ? "" : "\t", line);
}

/// Choices in the type name of an option: "TEXT:{bash,zsh,fish}".
std::vector<std::string> choices_of(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    const auto from = type.find('{'), to = type.find('}');
    if (from == type.npos || to == type.npos) return {};
    std::stringstream list(type.substr(from + 1, to - from - 1));
    std::vector<std::string> words;
    for (std::string word; std::getline(list, word, ',');) words.push_back(word);
    return words;
}

void offer_values(const CLI::Option& option, const std::string& word) {
    for (const std::string& choice : choices_of(option)) offer(word, choice);
    const std::string type = option.get_type_name();
    if (type == "DIR") print_out(":folders\n");
    if (type == "FILE") print_out(":files\n");
    if (type == "KEY=VALUE" && option.check_name("--set"))
        for (const Key& key : keys()) offer(word, std::string(key.name) + "=");
}

/// The candidates for the last word of a command line. `:files` and `:folders` stand for those that the shell
/// finds.
void complete(const CLI::App& app, std::vector<std::string> words) {
    if (words.size() > 1 && is_python_command(words)) {
        words.insert(words.begin(), "complete");
        run_python_module("mcdem.run_command", words);
        return;
    }
    const std::string word = words.empty() ? "" : words.back();
    if (!words.empty()) words.pop_back();
    const CLI::App* command = &app;
    for (const std::string& name : words)
        for (const CLI::App* one : listed_commands(*command))
            if (one->get_name() == name) command = one;
    const auto options = command->get_options(
        [](const CLI::Option* one) { return !one->get_positional() && !one->get_group().empty(); });
    for (const CLI::Option* option : options)
        if (option->get_items_expected_max() > 0 && !words.empty() && option->check_name(words.back()))
            return offer_values(*option, word);
    if (word.starts_with("-")) {
        for (const CLI::Option* option : options) {
            for (const auto& name : option->get_lnames()) offer(word, "--" + name, option->get_description());
            for (const auto& name : option->get_snames()) offer(word, "-" + name, option->get_description());
        }
        return;
    }
    for (const CLI::App* one : listed_commands(*command))
        offer(word, one->get_name(), one->get_description());
    for (const CLI::Option* positional :
         command->get_options([](const CLI::Option* one) { return one->get_positional(); })) {
        const auto choices = choices_of(*positional);
        for (const std::string& choice : choices) offer(word, choice);
        if (choices.empty()) return print_out(":files\n");
    }
}

constexpr auto bash_script = R"script(# bash completion of mcdem, as `mcdem completion bash` writes it
_mcdem() {
    local current=${COMP_WORDS[COMP_CWORD]} line
    COMPREPLY=()
    while IFS= read -r line; do
        case $line in
        :files) compopt -o filenames; COMPREPLY+=($(compgen -f -- "$current")) ;;
        :folders) compopt -o filenames; COMPREPLY+=($(compgen -d -- "$current")) ;;
        *=) compopt -o nospace; COMPREPLY+=("$line") ;;
        *) COMPREPLY+=("${line%%$'\t'*}") ;;
        esac
    done < <("${COMP_WORDS[0]/#\~/$HOME}" complete -- "${COMP_WORDS[@]:1:COMP_CWORD}" 2> /dev/null)
}
complete -F _mcdem mcdem
)script";

constexpr auto zsh_script = R"script(#compdef mcdem
# zsh completion of mcdem, as `mcdem completion zsh` writes it
_mcdem() {
    local line
    local -a candidates
    for line in "${(@f)$(${~words[1]} complete -- "${(@)words[2,CURRENT]}" 2> /dev/null)}"; do
        case $line in
        :files) _files ;;
        :folders) _files -/ ;;
        *=) compadd -S '' -- $line ;;
        *) candidates+=("${${line//:/\\:}/$'\t'/:}") ;;
        esac
    done
    if (( $#candidates )); then _describe mcdem candidates; fi
}
if [[ $funcstack[1] == _mcdem ]]; then _mcdem "$@"; else compdef _mcdem mcdem; fi
)script";

constexpr auto fish_script = R"script(# fish completion of mcdem, as `mcdem completion fish` writes it
function __mcdem_complete
    set -l words (commandline -opc)
    for line in ($words[1] complete -- $words[2..] (commandline -ct) 2> /dev/null)
        switch $line
            case :files
                __fish_complete_path (commandline -ct)
            case :folders
                __fish_complete_directories (commandline -ct)
            case '*'
                echo $line
        end
    end
end
complete -c mcdem -f -a '(__mcdem_complete)'
)script";

}  // namespace

void add_completion(CLI::App& app, int&) {
    auto* sub = app.add_subcommand("completion", "Print a shell completion script");
    auto shell = std::make_shared<std::string>();
    sub->add_option("SHELL", *shell, "bash, zsh or fish")
        ->required()
        ->check(CLI::IsMember({"bash", "zsh", "fish"}));
    sub->footer(
        "Installed by `cmake --install`. Without installing, for the current shell:\n"
        "  source <(mcdem completion bash)");
    sub->callback([shell] {
        print_out("{}", *shell == "zsh" ? zsh_script : *shell == "fish" ? fish_script : bash_script);
    });
    auto* asked = app.add_subcommand("complete", "Words that can follow")->group("");
    auto words = std::make_shared<std::vector<std::string>>();
    asked->add_option("WORD", *words, "Words after the program's name");
    asked->callback([&app, words] { complete(app, *words); });
}

}  // namespace mcdem::cli
