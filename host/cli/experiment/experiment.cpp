#include "cli/experiment/experiment.h"

#include <fmt/format.h>

#include "cli/shell/commands.h"
#include "cli/shell/standard_streams.h"
#include "core/errors.h"
#include "diagnose/observe/needed_to_diagnose.h"
#include "experiment/check_experiment.h"

namespace mcdem::inline cli {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t line_length = 110;

/// Wraps a text; all lines but the first are indented to the text.
std::string wrapped(const std::string& head, const std::string& text) {
    const std::string indent(head.size(), ' ');
    std::string all, line = head;
    for (std::size_t first = 0; first < text.size();) {
        const auto end = std::min(text.find(' ', first), text.size());
        const std::string word = text.substr(first, end - first);
        if (line.size() + 1 + word.size() > line_length && line.size() > head.size()) {
            all += line + '\n';
            line = indent;
        }
        line += (line.size() > head.size() ? " " : "") + word;
        first = end + 1;
    }
    return all + line + '\n';
}

std::string_view title(Severity severity) {
    switch (severity) {
        case Severity::note:
            return "available data";
        case Severity::missing:
            return "missing data, and what they would show";
        case Severity::odd:
            return "suspicious data";
    }
    return "";
}

void print_check(const std::string& folder) {
    const Experiment experiment = read_experiment(folder);
    const ExperimentCheck check = check_experiment(experiment);
    print_out("{}\n", experiment.name);
    for (const Severity severity : {Severity::note, Severity::missing, Severity::odd}) {
        if (check.of(severity).empty()) {
            if (severity != Severity::note) print_out("\n{}: nothing\n", title(severity));
            continue;
        }
        print_out("\n{}\n", title(severity));
        for (const Finding& finding : check.findings)
            if (finding.severity == severity)
                print_out("{}", wrapped(fmt::format("  {:<16}", finding.about), finding.text));
    }
    const auto needed = needed_to_diagnose(experiment);
    print_out("\nrequired by `mcdem diagnose` in addition{}\n", needed.empty() ? ": nothing" : "");
    for (const std::string& text : needed) print_out("{}", wrapped("  ", text));
}

void add_experiment_check(CLI::App& experiment) {
    auto* sub = experiment.add_subcommand(
        "check", "Report which data an experiment contains, which are missing and which are suspicious");
    auto folder = std::make_shared<std::string>();
    sub->add_option("DIR", *folder, "Experiment folder")->required();
    sub->footer(
        "The last lines say what must be added before `mcdem diagnose` accepts the folder.\n"
        "The exit code is 0 if the folder can be read, and 2 if it cannot.\n"
        "Example:\n"
        "  mcdem experiment check out/lab");
    sub->callback([folder] { print_check(*folder); });
}

}  // namespace

fs::path whole_path(const std::string& folder) {
    const fs::path path = fs::absolute(folder).lexically_normal();
    return path.has_filename() ? path : path.parent_path();
}

Experiment read_back(const fs::path& folder, const std::string& out, const std::string& heading) {
    try {
        return read_experiment(folder);
    } catch (const InputError& error) {
        std::vector<std::string> problems{heading};
        for (std::string problem : error.problems()) {
            if (problem.starts_with(folder.string())) problem.replace(0, folder.string().size(), out);
            problems.push_back(problem);
        }
        throw InputError(problems);
    }
}

void add_experiment(CLI::App& app, int& exit_code) {
    auto* sub = app.add_subcommand(
        "experiment", "Check an experiment folder, or make one from tables or from a simulation");
    sub->require_subcommand(1);
    add_experiment_check(*sub);
    add_experiment_import(*sub, exit_code);
    add_experiment_from_run(*sub);
    sub->footer(
        "An experiment's folder is described in host/experiment/README.md.\n"
        "Examples:\n"
        "  mcdem experiment import data/plate.txt data/grains.txt --set 'box.size=[0.165, 0.166]' --out "
        "out/lab\n"
        "  mcdem experiment check out/lab\n"
        "  mcdem experiment from-run out/begun --replica mc_dem --out out/measured");
}

}  // namespace mcdem::cli
