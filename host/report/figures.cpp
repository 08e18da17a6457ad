#include "report/figures.h"

#include <cstdlib>
#include <fstream>

#include "core/atomic_file.h"
#include "core/errors.h"
#include "report/figure_parts.h"
#include "report/gnuplot.h"

namespace mcdem {
namespace {

/// Pictures are drawn in a folder of their own and then moved into place, so that a reader sees whole ones.
class DrawingFolder {
public:
    explicit DrawingFolder(const std::filesystem::path& beside) {
        auto pattern = (beside / ".drawing-XXXXXX").string();
        if (!::mkdtemp(pattern.data()))
            throw RunError(beside.string() +
                           ": must be a folder that can be written to, to draw pictures in");
        path_ = pattern;
    }
    ~DrawingFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    DrawingFolder(const DrawingFolder&) = delete;
    DrawingFolder& operator=(const DrawingFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

void draw(const Figure& figure, const std::filesystem::path& folder, Drawn& drawn) {
    const DrawingFolder drawing(folder);
    const auto write = [&](const std::string& ending, const std::string& text) {
        std::ofstream(drawing.path() / (figure.name + ending)) << text;
        replace_file(folder / (figure.name + ending), text);
    };
    write(".csv", figure.data);
    write(".gp", figure.script);
    gnuplot::run(drawing.path(), figure.name + ".gp");
    for (const char* ending : {".png", ".svg"}) {
        const auto file = folder / (figure.name + ending);
        replace_file(file, [&](const std::filesystem::path& temporary) {
            std::filesystem::rename(drawing.path() / file.filename(), temporary);
        });
        drawn.pictures.push_back(file);
    }
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
