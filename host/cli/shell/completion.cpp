// mcdem completion: scripts for shells, written from the program's own commands and options.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cli/shell/command_tree.h"
#include "cli/shell/commands.h"
#include "cli/shell/standard_streams.h"
#include "core/replaced.h"
#include "scene/keys.h"

namespace mcdem::inline cli {
namespace {

/// How a shell completes the value of an option.
struct Actions {
    const char *folder, *file, *scene_key;
    const char* word;  ///< with {} for the allowed words
    const char* anything;
};

std::string action_of(const OptionEntry& option, const Actions& actions) {
    if (!option.choices.empty())
        return fmt::format(fmt::runtime(actions.word), fmt::join(option.choices, " "));
    if (option.value == "DIR") return actions.folder;
    if (option.value == "FILE") return actions.file;
    if (option.value == "KEY=VALUE" && option.names.front() == "--set") return actions.scene_key;
    return actions.anything;
}

/// In single quotes, for all three shells.
std::string in_quotes(const std::string& text) {
    return "'" + replaced(text, {{'\'', "'\\''"}, {'\n', " "}}) + "'";
}

std::string place_of(const CommandEntry& command) {
    std::string place = command.path.empty() ? "" : "/" + command.path;
    std::ranges::replace(place, ' ', '/');
    return place;
}

/// All commands as one pattern of `case`.
std::string places(const std::vector<CommandEntry>& tree) {
    std::string pattern;
    for (const CommandEntry& command : tree)
        if (!command.path.empty()) pattern += (pattern.empty() ? "" : "|") + place_of(command);
    return pattern;
}

/// One line per command and option with a value: `"PLACE --option") ACTION ;;`.
std::string value_cases(const std::vector<CommandEntry>& tree, const Actions& actions) {
    std::string cases;
    for (const CommandEntry& command : tree)
        for (const OptionEntry& option : command.options)
            if (!option.value.empty())
                for (const std::string& name : option.names)
                    cases += fmt::format("        \"{} {}\") {} ;;\n", place_of(command), name,
                                         action_of(option, actions));
    return cases;
}

std::vector<std::string> all_names(const std::vector<OptionEntry>& options) {
    std::vector<std::string> names;
    for (const OptionEntry& option : options)
        names.insert(names.end(), option.names.begin(), option.names.end());
    return names;
}

/// Allowed words of a command without files and subcommands.
std::vector<std::string> choices_of(const CommandEntry& command) {
    for (const OptionEntry& positional : command.positionals)
        if (!positional.choices.empty()) return positional.choices;
    return {};
}

bool takes_files(const CommandEntry& command) {
    return !command.positionals.empty() && choices_of(command).empty();
}

constexpr Actions bash_actions{
    .folder = "compopt -o filenames; COMPREPLY=($(compgen -d -- \"$current\")); return",
    .file = "compopt -o filenames; COMPREPLY=($(compgen -f -- \"$current\")); return",
    .scene_key = "compopt -o nospace; COMPREPLY=($(compgen -S = -W \"$keys\" -- \"$current\")); return",
    .word = "COMPREPLY=($(compgen -W '{}' -- \"$current\")); return",
    .anything = "return"};

std::string bash_script(const std::vector<CommandEntry>& tree, const std::string& keys) {
    std::string commands;
    for (const CommandEntry& command : tree) {
        auto words = command.commands;
        for (const std::string& word : choices_of(command)) words.push_back(word);
        commands += fmt::format("        \"{}\") options='{}' words='{}' files={} ;;\n", place_of(command),
                                fmt::join(all_names(command.options), " "), fmt::join(words, " "),
                                takes_files(command) ? "yes" : "");
    }
    return fmt::format(R"(# bash completion of mcdem, as `mcdem completion bash` writes it
_mcdem() {{
    local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}}
    local place='' word options='' words='' files=''
    local keys='{}'
    COMPREPLY=()
    for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
        case "$place/$word" in
        {}) place+=/$word ;;
        esac
    done
    case "$place $previous" in
{}    esac
    case "$place" in
{}    esac
    if [[ $current == -* ]]; then
        COMPREPLY=($(compgen -W "$options" -- "$current"))
    else
        COMPREPLY=($(compgen -W "$words" -- "$current"))
        if [[ -n $files ]]; then
            compopt -o filenames
            COMPREPLY+=($(compgen -f -- "$current"))
        fi
    fi
}}
complete -F _mcdem mcdem
)",
                       keys, places(tree), value_cases(tree, bash_actions), commands);
}

constexpr Actions zsh_actions{.folder = "_files -/; return",
                              .file = "_files; return",
                              .scene_key = "compadd -S = -- $keys; return",
                              .word = "compadd -- {}; return",
                              .anything = "_message 'value'; return"};

/// 'name:description', for _describe.
std::string zsh_entry(const std::string& name, const std::string& help) {
    return " " + in_quotes(name + ":" + replaced(help, {{':', "\\:"}}));
}

std::string zsh_script(const std::vector<CommandEntry>& tree, const std::string& keys) {
    std::string commands;
    for (const CommandEntry& command : tree) {
        std::string options, words;
        for (const OptionEntry& option : command.options)
            for (const std::string& name : option.names) options += zsh_entry(name, option.help);
        for (const std::string& name : command.commands)
            words += zsh_entry(name, below(tree, command.path, name).about);
        for (const std::string& word : choices_of(command)) words += " " + word;
        commands += fmt::format("        \"{}\") options=({}) words_here=({}) files={} ;;\n",
                                place_of(command), options, words, takes_files(command) ? "yes" : "''");
    }
    return fmt::format(R"(#compdef mcdem
# zsh completion of mcdem, as `mcdem completion zsh` writes it
_mcdem() {{
    local place='' word files=''
    local -a options words_here keys
    keys=({})
    for word in ${{words[2,CURRENT-1]}}; do
        case "$place/$word" in
        {}) place+=/$word ;;
        esac
    done
    case "$place ${{words[CURRENT-1]}}" in
{}    esac
    case "$place" in
{}    esac
    if [[ ${{words[CURRENT]}} == -* ]]; then
        _describe -o option options
    else
        if (( $#words_here )); then _describe command words_here; fi
        if [[ -n $files ]]; then _files; fi
    fi
}}
if [[ $funcstack[1] == _mcdem ]]; then _mcdem "$@"; else compdef _mcdem mcdem; fi
)",
                       keys, places(tree), value_cases(tree, zsh_actions), commands);
}

constexpr Actions fish_actions{.folder = "-x -a '(__fish_complete_directories (commandline -ct))'",
                               .file = "-r -F",
                               .scene_key = "-x -a '(__mcdem_keys)'",
                               .word = "-x -a '{}'",
                               .anything = "-x"};

std::string fish_lines(const std::vector<CommandEntry>& tree, const CommandEntry& command) {
    const std::string start = fmt::format("complete -c mcdem -n '__mcdem_at \"{}\"'", place_of(command));
    std::string lines = start + (takes_files(command) ? " -F\n" : " -f\n");
    for (const OptionEntry& option : command.options) {
        std::string names;
        for (const std::string& name : option.names)
            names += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
        lines +=
            fmt::format("{}{} {} -d {}\n", start, names,
                        option.value.empty() ? "" : action_of(option, fish_actions), in_quotes(option.help));
    }
    for (const std::string& name : command.commands)
        lines +=
            fmt::format("{} -a {} -d {}\n", start, name, in_quotes(below(tree, command.path, name).about));
    if (!choices_of(command).empty())
        lines += fmt::format("{} -a '{}'\n", start, fmt::join(choices_of(command), " "));
    return lines;
}

std::string fish_script(const std::vector<CommandEntry>& tree, const std::string& keys) {
    std::string commands;
    for (const CommandEntry& command : tree) commands += fish_lines(tree, command);
    return fmt::format(R"(# fish completion of mcdem, as `mcdem completion fish` writes it
function __mcdem_at
    set -l place ''
    for word in (commandline -opc)[2..-1]
        contains -- "$place/$word" {}; and set place "$place/$word"
    end
    test "$place" = "$argv[1]"
end
function __mcdem_keys
    string join \n -- {} | string replace -r '$' '='
end
{})",
                       replaced(places(tree), {{'|', " "}}), keys, commands);
}

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
    sub->callback([&app, shell] {
        std::vector<std::string_view> names;  // complete what is given as KEY=VALUE
        for (const Key& key : keys()) names.push_back(key.name);
        const auto script = *shell == "zsh" ? zsh_script : *shell == "fish" ? fish_script : bash_script;
        print_out("{}", script(command_tree(app), fmt::format("{}", fmt::join(names, " "))));
    });
}

}  // namespace mcdem::cli
