#include "cli/run/figures.h"

#include <fmt/format.h>

#include "cli/shell/commands.h"
#include "cli/shell/messages.h"
#include "cli/shell/python_program.h"
#include "core/errors.h"
#include "core/look.h"
#include "core/make_folder.h"
#include "core/output_file.h"
#include "io/result_folder.h"
#include "io/results.h"
#include "report/run/figure_values.h"

namespace mcdem::inline cli {
namespace {

namespace fs = std::filesystem;

/// Larger runs are read into memory only on request.
constexpr std::uintmax_t max_bytes_read = std::uintmax_t{1} << 30;

const char* const values_file = "figures.json";

}  // namespace

void expect_replaceable_figures(const fs::path& folder, const std::vector<std::string>& names) {
    expect_replaceable(folder / values_file, FileKind::figure_values);
    for (const auto& name : names)
        for (const char* ending : {".pdf", ".png", ".svg"})
            expect_replaceable(folder / (name + ending), FileKind::figure);
}

std::vector<fs::path> draw_figures(const fs::path& folder, const nlohmann::ordered_json& values) {
    std::vector<std::string> names;
    std::vector<fs::path> figures;
    for (const auto& [name, _] : values.items()) {
        names.push_back(name);
        figures.push_back(folder / (name + ".png"));
    }
    expect_replaceable_figures(folder, names);
    replace_own(folder / values_file, FileKind::figure_values, figure_file(values));
    const int code = run_python_module("mcdem.figures", {(folder / values_file).string()});
    if (code == exit_interrupted) throw Interrupted();
    if (code != exit_done)
        throw RunError(fmt::format("{} could not be drawn: Python ended with exit code {}",
                                   (folder / values_file).string(), code));
    return figures;
}

std::vector<fs::path> draw_runs(const fs::path& folder, const std::vector<Setting>& settings,
                                const std::optional<Setting>& reference, const FigureOptions& options) {
    make_folder(folder);
    const auto data = figure_data(settings, reference, options);
    const auto prepared = run_figures(data, options);
    for (const auto& missing : prepared.missing) spdlog::info("no figure of {}", missing);
    return draw_figures(folder, figure_values(prepared, data));
}

std::vector<fs::path> draw_if_possible(const std::function<std::vector<fs::path>()>& draw) {
    try {
        return draw();
    } catch (const std::exception& error) {
        spdlog::warn("no figures: {}", error.what());
        return {};
    }
}

std::vector<fs::path> draw_run(const fs::path& folder) {
    if (size_of_file(run_file(folder)) > max_bytes_read) {
        spdlog::info("no figures of so large a run: `mcdem figures {} --out DIR` draws them",
                     folder.string());
        return {};
    }
    return draw_if_possible([&] {
        const Run run = read_run(folder, ReadWhat::contacts);
        return draw_runs(folder, group_by_setting(run), std::nullopt);
    });
}

void add_figure_options(CLI::App& command, FigureOptions& figures) {
    command
        .add_option("--displacement", figures.distribution_displacement,
                    "Draw the force distribution at the recorded plate displacement nearest to this one [m]")
        ->type_name("M")
        ->check(at_least_zero());
    command
        .add_option("--threshold", figures.threshold,
                    "Contact force below which contacts are not counted in the figure of Z if there is "
                    "no reference [N]")
        ->type_name("N")
        ->check(at_least_zero());
}

}  // namespace mcdem::cli
