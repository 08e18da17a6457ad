#include "report/draw_figure.h"

#include <cstdlib>
#include <fstream>

#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/input_file.h"
#include "core/output_file.h"
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
        std::error_code error;
        // A signal may come in between, and then not all is removed, with an error or without.
        for (int tries = 0; tries < 3 && std::filesystem::exists(path_, error); ++tries)
            std::filesystem::remove_all(path_, error);
    }
    DrawingFolder(const DrawingFolder&) = delete;
    DrawingFolder& operator=(const DrawingFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

}  // namespace

void expect_replaceable_figure(const std::filesystem::path& folder, const std::string& name) {
    const auto script = folder / (name + ".gp");
    expect_replaceable(script, FileKind::script);
    if (std::filesystem::exists(script)) return;
    for (const char* ending : {".csv", ".png", ".svg"})
        if (const auto file = folder / (name + ending); std::filesystem::exists(file))
            throw InputError(
                file.string() + ": was not drawn by mcdem (" + script.filename().string() +
                " is not beside it), and is not replaced: give another place (--out), or remove it first");
}

std::vector<std::filesystem::path> draw_figure(const Figure& figure, const std::filesystem::path& folder) {
    expect_replaceable_figure(folder, figure.name);
    const DrawingFolder drawing(folder);
    const auto write = [&](const std::string& ending, const std::string& text) {
        std::ofstream(drawing.path() / (figure.name + ending)) << text;
        replace_file(folder / (figure.name + ending), text);
    };
    write(".gp", sealed_script(figure.script));  // first: by it the others are known
    write(".csv", figure.data);
    gnuplot::run(drawing.path(), figure.name + ".gp");
    std::vector<std::filesystem::path> pictures;
    for (const char* ending : {".png", ".svg"}) {
        pictures.push_back(folder / (figure.name + ending));
        replace_file(pictures.back(), read_file(drawing.path() / pictures.back().filename()));
    }
    return pictures;
}

}  // namespace mcdem
