#include "report/figures.h"

#include "report/draw_figure.h"
#include "report/figure_parts.h"

namespace mcdem {
namespace {

void draw(const Figure& figure, const std::filesystem::path& folder, Drawn& drawn) {
    for (auto& picture : draw_figure(figure, folder)) drawn.pictures.push_back(std::move(picture));
}

}  // namespace

Drawn draw_figures(const std::vector<Setting>& settings, const std::optional<Setting>& reference,
                   const std::filesystem::path& folder, const FigureOptions& options) {
    Drawn drawn;
    const auto cast = cast_of(settings, reference, options);
    if (cast.simulated.empty()) {
        drawn.notes.push_back("no pictures: no scans are left after the discarded cycles");
        return drawn;
    }
    const auto draw_or_note = [&](const std::optional<Figure>& figure, const char* otherwise) {
        if (figure)
            draw(*figure, folder, drawn);
        else
            drawn.notes.push_back(otherwise);
    };
    draw(top_force_figure(cast), folder, drawn);
    draw_or_note(distribution_figure(cast, options),
                 "no picture of the force distribution: no contacts recorded");
    draw_or_note(coordination_figure(cast, options), "no picture of Z: contacts per grain are not known");
    draw_or_note(scaling_figure(cast),
                 "no picture of the scaling law: averages over the packing are not known");
    return drawn;
}

}  // namespace mcdem
