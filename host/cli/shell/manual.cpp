// mcdem manual: roff pages, written from the program's own help.
#include <fmt/format.h>

#include <filesystem>

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

/// "mcdem-experiment-check" with '-' between.
std::string full_name(const CLI::App& command, char between) {
    const CLI::App* parent = command.get_parent();
    return parent ? full_name(*parent, between) + between + command.get_name() : "mcdem";
}

std::vector<const CLI::Option*> options_of(const CLI::App& command, bool positional) {
    return command.get_options([=](const CLI::Option* one) { return one->get_positional() == positional; });
}

std::string list_of(const std::string& heading, const CLI::App& command, bool positional) {
    const CLI::Formatter format;
    std::string roff;
    for (const CLI::Option* option : options_of(command, positional))
        roff += fmt::format(
            ".TP\n.B {}\n{}\n",
            literal(format.make_option_name(option, positional) + format.make_option_opts(option)),
            literal(format.make_option_desc(option)));
    return roff.empty() ? "" : ".SH " + heading + "\n" + roff;
}

std::string synopsis(const CLI::App& command) {
    std::string roff = ".SH SYNOPSIS\n.B " + literal(full_name(command, ' ')) + "\n[\\fIOPTIONS\\fR]";
    for (const CLI::Option* positional : options_of(command, true))
        roff += " \\fI" + literal(positional->get_name(true)) + "\\fR";
    return roff + (listed_commands(command).empty() ? "\n" : " \\fICOMMAND\\fR ...\n");
}

std::string commands_of(const CLI::App& command) {
    std::string roff;
    for (const CLI::App* one : listed_commands(command))
        roff += fmt::format(".TP\n.BR {} (1)\n{}\n", literal(full_name(*one, '-')),
                            literal(one->get_description()));
    return roff.empty() ? "" : ".SH COMMANDS\n" + roff;
}

std::string page(const CLI::App& command) {
    const std::string name = full_name(command, '-');
    const std::string version = std::string(version_text).substr(0, std::string(version_text).find(' '));
    std::string upper = name;
    for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    std::string roff = fmt::format(".TH {} 1 \"\" \"mcdem {}\" \"User Commands\"\n", literal(upper), version);
    roff += fmt::format(".SH NAME\n{} \\- {}\n", literal(name),
                        literal(replaced(command.get_description(), {{'\n', " "}})));
    roff += synopsis(command) + commands_of(command);
    roff += list_of("ARGUMENTS", command, true) + list_of("OPTIONS", command, false);
    if (const std::string notes = command.get_footer(); !notes.empty())
        roff += ".SH NOTES\n.nf\n" + literal(notes) + "\n.fi\n";
    if (const CLI::App* parent = command.get_parent())
        roff += fmt::format(".SH SEE ALSO\n.BR {} (1)\n", literal(full_name(*parent, '-')));
    return roff;
}

void write_pages(const CLI::App& command, const std::filesystem::path& folder) {
    replace_own(folder / (full_name(command, '-') + ".1"), FileKind::manual, page(command));
    for (const CLI::App* one : listed_commands(command)) write_pages(*one, folder);
}

}  // namespace

std::vector<const CLI::App*> listed_commands(const CLI::App& command) {
    return command.get_subcommands([](const CLI::App* one) { return !one->get_group().empty(); });
}

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
        write_pages(app, *folder);
    });
}

}  // namespace mcdem::cli
