#include "cli/pictures.h"

#include <fmt/format.h>

#include "cli/messages.h"
#include "core/make_folder.h"
#include "io/result_folder.h"
#include "io/results.h"

namespace mcdem {
namespace {

/// Larger runs are not read into memory unasked.
constexpr std::uintmax_t most_bytes_read = std::uintmax_t{1} << 30;

}  // namespace

std::vector<std::filesystem::path> draw_into(const std::filesystem::path& folder,
                                             const std::vector<Setting>& settings,
                                             const std::optional<Setting>& reference,
                                             const FigureOptions& options) {
    make_folder(folder);
    const auto drawn = draw_figures(settings, reference, folder, options);
    for (const auto& note : drawn.notes) spdlog::info("{}", note);
    std::vector<std::filesystem::path> pictures;
    for (const auto& picture : drawn.pictures)
        if (picture.extension() == ".png") pictures.push_back(picture);
    return pictures;
}

std::vector<std::filesystem::path> draw_run(const std::filesystem::path& folder) {
    if (std::filesystem::file_size(run_file(folder)) > most_bytes_read) {
        spdlog::info("no pictures of so large a run: `mcdem figures {} --out DIR` draws them",
                     folder.string());
        return {};
    }
    try {
        const Run run = read_run(folder, ReadWhat::contacts);
        return draw_into(folder, group_by_setting(run), std::nullopt);
    } catch (const std::exception& error) {
        spdlog::warn("no pictures: {}", error.what());
        return {};
    }
}

void add_figure_options(CLI::App& command, FigureOptions& figures) {
    command
        .add_option("--displacement", figures.distribution_displacement,
                    "Force distribution at the level nearest to this plate displacement [m]")
        ->type_name("M")
        ->capture_default_str();
    command
        .add_option("--threshold", figures.threshold,
                    "Contact forces below it do not count in the picture of Z, without a reference [N]")
        ->type_name("N")
        ->capture_default_str();
}

}  // namespace mcdem
