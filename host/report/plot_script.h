// Puts a figure together: a CSV file of blocks, and a gnuplot script that draws it as PNG and SVG. Both
// are kept beside the picture, so that it can be restyled with `gnuplot NAME.gp`.
#pragma once
#include <string>
#include <vector>

#include "metrics/replicas.h"

namespace mcdem {

/// Colour and point shapes of one series.
struct SeriesStyle {
    std::string colour;    ///< "#rrggbb"
    int filled_point = 7;  ///< gnuplot's point types
    int open_point = 6;
};

/// Black circles: what simulations are held against.
SeriesStyle reference_style();

/// Colours that the colour-blind can tell apart (Okabe and Ito). A contact model keeps its colour from
/// figure to figure where every setting has another model; else colours follow the order of the settings.
std::vector<SeriesStyle> styles_of(const std::vector<Setting>& settings);

/// A picture, ready to be drawn.
struct Figure {
    std::string name;    ///< of its files, without extension
    std::string data;    ///< CSV
    std::string script;  ///< gnuplot
};

/// Collects data and plot elements of one figure.
class PlotScript {
public:
    /// `about` opens the script as a comment; `header` is the CSV's first line.
    PlotScript(std::string name, std::string about, std::string header);
    /// Of the whole picture; 1000 x 600 where nothing is said [pixels of the SVG, half those of the PNG].
    void size(int width, int height) { width_ = width, height_ = height; }
    /// Starts another set of axes, with settings and plots of its own; its margins say where it stands.
    void panel();
    /// A gnuplot setting, without `set`: must hold no text from outside.
    void set(const std::string& setting);
    void unset(const std::string& setting);
    void title(const std::string& text);
    /// Text from anywhere; `how` is what follows it in gnuplot's `set label`: position, alignment, font (the
    /// colour is ink).
    void label(const std::string& text, const std::string& how);
    /// A block of rows of CSV fields; its number is what `plot` refers to.
    int add_block(const std::vector<std::vector<std::string>>& rows);
    /// Draws a block: `how` is gnuplot's `using .. with ..`.
    void plot(int block, const std::string& how);
    /// A line of the key alone; `how` is gnuplot's `with ..`.
    void key(const std::string& text, const std::string& how);
    Figure figure() const;

private:
    struct Panel {
        std::string settings;
        std::vector<std::string> elements;  ///< of its `plot`
    };
    std::string drawing() const;

    std::string name_, about_, data_, blank_lines_;
    std::vector<Panel> panels_;
    int blocks_ = 0, width_ = 1000, height_ = 600;
};

}  // namespace mcdem
