// mcdem completion: scripts for shells. They ask the program itself what can follow (the hidden command
// `complete`).
#include <fmt/format.h>

#include <algorithm>

#include "cli/shell/command_tree.h"
#include "cli/shell/commands.h"
#include "cli/shell/standard_streams.h"
#include "scene/keys.h"

namespace mcdem::inline cli {
namespace {

/// Prints one candidate, if it continues the word: `CANDIDATE`, or `CANDIDATE<tab>DESCRIPTION`.
void offer(const std::string& word, const std::string& candidate, const std::string& description = "") {
    if (!candidate.starts_with(word)) return;
    const std::string line = description.substr(0, description.find('\n'));
    print_out("{}{}{}\n", candidate, line.empty() ? "" : "\t", line);
}

void offer_values(const OptionEntry& option, const std::string& word) {
    for (const std::string& choice : option.choices) offer(word, choice);
    if (option.value == "DIR") print_out(":folders\n");
    if (option.value == "FILE") print_out(":files\n");
    if (option.value == "KEY=VALUE" && option.names.front() == "--set")
        for (const Key& key : keys()) offer(word, std::string(key.name) + "=");
}

/// The candidates for the last word of a command line. `:files` and `:folders` stand for those that the shell
/// finds.
void complete(const std::vector<CommandEntry>& tree, std::vector<std::string> words) {
    const std::string word = words.empty() ? "" : words.back();
    if (!words.empty()) words.pop_back();
    const CommandEntry* command = &tree.front();
    for (const std::string& name : words)
        if (std::ranges::count(command->commands, name)) command = &below(tree, command->path, name);
    for (const OptionEntry& option : command->options)
        if (!option.value.empty() && !words.empty() && std::ranges::count(option.names, words.back()))
            return offer_values(option, word);
    if (word.starts_with("-")) {
        for (const OptionEntry& option : command->options)
            for (const std::string& name : option.names) offer(word, name, option.help);
        return;
    }
    for (const std::string& name : command->commands)
        offer(word, name, below(tree, command->path, name).about);
    for (const OptionEntry& positional : command->positionals) {
        for (const std::string& choice : positional.choices) offer(word, choice);
        if (positional.choices.empty()) return print_out(":files\n");
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
    asked->callback([&app, words] { complete(command_tree(app), *words); });
}

}  // namespace mcdem::cli
