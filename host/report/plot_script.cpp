#include "report/plot_script.h"

#include <fmt/format.h>

#include <array>
#include <set>

#include "report/gnuplot.h"

namespace mcdem {
namespace {

// Okabe & Ito 2008, less yellow (too faint on white) and black (the reference). The first six are in
// the order of ContactModel.
constexpr std::array<const char*, 7> palette{"#0072B2", "#56B4E9", "#009E73", "#E69F00",
                                             "#D55E00", "#CC79A7", "#666666"};
constexpr std::array<int, 7> filled_points{5, 9, 11, 13, 7, 15, 5};

SeriesStyle style_number(std::size_t index) {
    const std::size_t i = index % palette.size();
    return {palette[i], filled_points[i], filled_points[i] - 1};
}

// Text from outside comes in through `title`, `label` and `key` only, and those are drawn as they stand.
constexpr const char* preamble = R"(set encoding utf8
set datafile separator comma
set border 3 linecolor rgb '#444444' linewidth 1
set tics nomirror out scale 0.6 textcolor rgb '#222222'
set grid xtics ytics linecolor rgb '#dddddd' linewidth 0.6 linetype 1
set key outside right center Left reverse noenhanced samplen 2.2 spacing 1.25 textcolor rgb '#222222'
set style fill transparent solid 0.18 noborder
set lmargin 9
set bmargin 4
set autoscale xfixmax
set offsets 0, graph 0.02, 0, 0
)";

constexpr const char* both_formats =
    R"(do for [ending in 'png svg'] {{
if (ending eq 'png') {{
set terminal pngcairo size {2},{3} font 'Sans,12' fontscale 2 linewidth 2 pointscale 2
}} else {{
set terminal svg size {0},{1} dynamic font 'Sans,12' fontscale 1.25 linewidth 1.2 background rgb 'white'
}}
set output '{4}.'.ending
{5}}}
set output
)";

}  // namespace

SeriesStyle reference_style() { return {"#000000", 7, 6}; }

std::vector<SeriesStyle> styles_of(const std::vector<Setting>& settings) {
    std::set<ContactModel> models;
    for (const auto& setting : settings)
        if (const auto model = model_of(setting.replicas)) models.insert(*model);
    const bool by_model = models.size() == settings.size();
    std::vector<SeriesStyle> styles;
    for (std::size_t s = 0; s < settings.size(); ++s)
        styles.push_back(
            style_number(by_model ? static_cast<std::size_t>(*model_of(settings[s].replicas)) : s));
    return styles;
}

PlotScript::PlotScript(std::string name, std::string about, std::string header)
    : name_(std::move(name)), about_(std::move(about)), data_(std::move(header) + "\n"), panels_(1) {}

void PlotScript::panel() {
    if (!panels_.back().elements.empty()) panels_.emplace_back();
}

void PlotScript::set(const std::string& setting) { panels_.back().settings += "set " + setting + "\n"; }

void PlotScript::unset(const std::string& setting) { panels_.back().settings += "unset " + setting + "\n"; }

void PlotScript::title(const std::string& text) {
    set("title " + gnuplot::quoted(text) + " noenhanced font ',14' textcolor rgb '#222222'");
}

void PlotScript::label(const std::string& text, const std::string& how) {
    set("label " + gnuplot::quoted(text) + " noenhanced textcolor rgb '#222222' " + how);
}

int PlotScript::add_block(const std::vector<std::vector<std::string>>& rows) {
    data_ += blank_lines_;
    blank_lines_ = "\n\n";  // two blank lines: another `index`
    for (const auto& row : rows) {
        for (std::size_t c = 0; c < row.size(); ++c) data_ += (c ? "," : "") + row[c];
        data_ += "\n";
    }
    return blocks_++;
}

void PlotScript::plot(int block, const std::string& how) {
    panels_.back().elements.push_back(fmt::format("'{}.csv' skip 1 index {} {} notitle", name_, block, how));
}

void PlotScript::key(const std::string& text, const std::string& how) {
    panels_.back().elements.push_back(fmt::format("keyentry {} title {}", how, gnuplot::quoted(text)));
}

std::string PlotScript::drawing() const {
    std::string drawing;
    for (const auto& [settings, elements] : panels_) {
        drawing += panels_.size() > 1 ? "reset\n" + std::string(preamble) + settings : "";
        drawing += "plot ";
        for (std::size_t e = 0; e < elements.size(); ++e) drawing += (e ? ", \\\n     " : "") + elements[e];
        drawing += "\n";
    }
    return panels_.size() > 1 ? "set multiplot\n" + drawing + "unset multiplot\n" : drawing;
}

Figure PlotScript::figure() const {
    const auto script =
        fmt::format("# {}\n# Change what you like, then run: gnuplot {}.gp\n", about_, name_) +
        (panels_.size() > 1 ? "" : preamble + panels_.front().settings) +
        fmt::format(fmt::runtime(both_formats), width_, height_, 2 * width_, 2 * height_, name_, drawing());
    return {name_, data_, script};
}

}  // namespace mcdem
