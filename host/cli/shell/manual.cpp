// mcdem manual: roff pages, written from the program's own help.
#include <fmt/format.h>

#include <filesystem>

#include "cli/shell/command_tree.h"
#include "cli/shell/commands.h"
#include "core/output_file.h"
#include "core/replaced.h"
#include "core/version.h"
#include "io/result_folder.h"

namespace mcdem::inline cli {
namespace {

/// Text for roff without escapes, requests at the start of a line, and special hyphens.
std::string literal(const std::string& text) {
    std::string roff;
    for (const char c : text) {
        if ((c == '.' || c == '\'') && (roff.empty() || roff.back() == '\n')) roff += "\\&";
        if (c == '\\')
            roff += "\\e";
        else if (c == '-')
            roff += "\\-";
        else
            roff += c;
    }
    return roff;
}

std::string page_name(const std::string& path) {
    return path.empty() ? "mcdem" : "mcdem-" + replaced(path, {{' ', "-"}});
}

std::string program_and(const std::string& path) { return path.empty() ? "mcdem" : "mcdem " + path; }

std::string list_of(const std::string& heading, const std::vector<OptionEntry>& options) {
    if (options.empty()) return "";
    std::string roff = ".SH " + heading + "\n";
    for (const OptionEntry& option : options)
        roff += fmt::format(".TP\n.B {}\n{}\n", literal(option.text), literal(option.help));
    return roff;
}

std::string synopsis(const CommandEntry& command) {
    std::string roff = ".SH SYNOPSIS\n.B " + literal(program_and(command.path)) + "\n[\\fIOPTIONS\\fR]";
    for (const OptionEntry& positional : command.positionals)
        roff += " \\fI" + literal(positional.names.front()) + "\\fR";
    return roff + (command.commands.empty() ? "\n" : " \\fICOMMAND\\fR ...\n");
}

std::string commands_of(const std::vector<CommandEntry>& tree, const CommandEntry& command) {
    if (command.commands.empty()) return "";
    std::string roff = ".SH COMMANDS\n";
    for (const std::string& name : command.commands) {
        const CommandEntry& entry = below(tree, command.path, name);
        roff += fmt::format(".TP\n.BR {} (1)\n{}\n", literal(page_name(entry.path)), literal(entry.about));
    }
    return roff;
}

std::string page(const std::vector<CommandEntry>& tree, const CommandEntry& command,
                 const std::string& version) {
    const std::string name = page_name(command.path);
    std::string upper = name;
    for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    std::string roff = fmt::format(".TH {} 1 \"\" \"mcdem {}\" \"User Commands\"\n", literal(upper), version);
    roff +=
        fmt::format(".SH NAME\n{} \\- {}\n", literal(name), literal(replaced(command.about, {{'\n', " "}})));
    roff += synopsis(command) + commands_of(tree, command);
    roff += list_of("ARGUMENTS", command.positionals) + list_of("OPTIONS", command.options);
    if (!command.notes.empty()) roff += ".SH NOTES\n.nf\n" + literal(command.notes) + "\n.fi\n";
    if (!command.path.empty()) {
        const auto space = command.path.rfind(' ');
        const std::string parent = space == command.path.npos ? "" : command.path.substr(0, space);
        roff += fmt::format(".SH SEE ALSO\n.BR {} (1)\n", literal(page_name(parent)));
    }
    return roff;
}

}  // namespace

void add_manual(CLI::App& app, int&) {
    auto* sub = app.add_subcommand("manual", "Write the manual pages of all commands to a folder");
    auto folder = std::make_shared<std::string>();
    sub->add_option("--out", *folder, "Folder for the pages; created if missing")
        ->required()
        ->type_name("DIR");
    sub->footer(
        "Installed by `cmake --install`. To read one without installing:\n"
        "  mcdem manual --out out/manual\n"
        "  man -l out/manual/mcdem-run.1");
    sub->callback([&app, folder] {
        const FolderLock lock = open_output_folder(*folder);
        const std::string version = std::string(version_text).substr(0, std::string(version_text).find(' '));
        const auto tree = command_tree(app);
        for (const CommandEntry& command : tree)
            replace_own(std::filesystem::path(*folder) / (page_name(command.path) + ".1"), FileKind::manual,
                        page(tree, command, version));
    });
}

}  // namespace mcdem::cli
