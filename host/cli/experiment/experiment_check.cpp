// mcdem experiment check
#include <fmt/format.h>

#include "cli/experiment/experiment.h"
#include "cli/shell/standard_streams.h"
#include "diagnose/observe/needed_to_diagnose.h"
#include "experiment/check_experiment.h"

namespace mcdem::inline cli {
namespace {

std::string_view title(Severity severity) {
    switch (severity) {
        case Severity::note:
            return "what there is";
        case Severity::missing:
            return "what is missing, and what it would allow";
        case Severity::odd:
            return "what looks odd";
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
    print_out("\nwhat `mcdem diagnose` also needs{}\n", needed.empty() ? ": nothing" : "");
    for (const std::string& text : needed) print_out("{}", wrapped("  ", text));
}

}  // namespace

void add_experiment_check(CLI::App& experiment) {
    auto* sub = experiment.add_subcommand(
        "check", "Report what an experiment contains, what is missing and what looks wrong");
    auto folder = std::make_shared<std::string>();
    sub->add_option("DIR", *folder, "Experiment folder")->required();
    sub->footer(
        "The last lines say what must be added before `mcdem diagnose` accepts the folder.\n"
        "The exit code is 0 if the folder can be read, and 2 if it cannot.\n"
        "Example:\n"
        "  mcdem experiment check data/hydrogel");
    sub->callback([folder] { print_check(*folder); });
}

}  // namespace mcdem::cli
