// mcdem experiment
#include "cli/experiment/experiment.h"

#include <fmt/format.h>

#include "cli/shell/commands.h"
#include "core/errors.h"

namespace mcdem::inline cli {
namespace {
constexpr std::size_t line_length = 110;
}

void expect_free(const std::filesystem::path& out) {
    std::error_code ignored;
    for (const char* taken : {"experiment.toml", "run.h5", "checkpoint.h5"})
        if (std::filesystem::exists(out / taken, ignored))
            throw InputError(
                fmt::format("--out: {} holds another experiment or run: name another folder", out.string()));
    for (const char* table : {"contacts.csv", "grains.csv", "plate.csv"})
        for (const char* end : {"", ".gz"})
            if (std::filesystem::exists(out / (std::string(table) + end), ignored))
                throw InputError(
                    fmt::format("--out: {} holds a table {}{} that would be of this experiment "
                                "then: name another folder, or remove it first",
                                out.string(), table, end));
    for (auto path = std::filesystem::absolute(out); path.has_relative_path(); path = path.parent_path())
        if (std::filesystem::exists(path, ignored) && !std::filesystem::is_directory(path, ignored))
            throw InputError(fmt::format("--out: {} must be a folder, got a file{}", out.string(),
                                         path.filename() == out.filename()
                                             ? ""
                                             : fmt::format(" in its way, {}", path.filename().string())));
}

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
        "  mcdem experiment check data/hydrogel\n"
        "  mcdem experiment import data/plate.txt data/grains.txt --set 'box.size=[0.165, 0.166]' --out "
        "out/lab\n"
        "  mcdem experiment from-run out/begun --replica mc_dem --out out/reality");
}

}  // namespace mcdem::cli
