#include "report/page/labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/names.h"

namespace mcdem::inline report {
namespace {

constexpr std::array<const char*, name_list<ContactModel>.size()> model_words{
    "Independent contacts", "Point force on sphere", "Sphere to sphere", "Elastic half space", "MC-DEM",
    "Elastic sphere",       "Hyperelastic sphere"};

// Okabe & Ito 2008, without yellow (too light on white) and black (the reference), in the order of
// ContactModel.
constexpr std::array<const char*, 7> palette{"#0072B2", "#56B4E9", "#009E73", "#E69F00",
                                             "#D55E00", "#CC79A7", "#666666"};
constexpr std::array<const char*, 7> markers{"s", "^", "v", "D", "o", "p", "h"};

/// Colours of matplotlib's "viridis", without the yellow end: readable by colour-blind readers and in grey.
constexpr std::array<std::array<int, 3>, 8> ramp{{{0x44, 0x01, 0x54},
                                                  {0x46, 0x32, 0x7e},
                                                  {0x36, 0x5c, 0x8d},
                                                  {0x27, 0x7f, 0x8e},
                                                  {0x1f, 0xa1, 0x87},
                                                  {0x4a, 0xc1, 0x6d},
                                                  {0x7f, 0xd3, 0x4e},
                                                  {0xc8, 0xe0, 0x20}}};

/// Colour at `place` between 0 and 1 of the ramp.
std::string ramp_colour(double place) {
    const double at = place * (ramp.size() - 1);
    const auto low = std::min(static_cast<std::size_t>(at), ramp.size() - 2);
    std::string colour = "#";
    for (std::size_t c = 0; c < 3; ++c)
        colour += fmt::format("{:02x}", std::lround(std::lerp(ramp[low][c], ramp[low + 1][c], at - low)));
    return colour;
}

}  // namespace

std::string words_for(const std::string& label) {
    const auto end = label.find_first_of(", ");
    const auto model = parse<ContactModel>(label.substr(0, end));
    if (!model) return one_line(label);
    const std::string rest = end == std::string::npos ? "" : label.substr(end);
    return model_words[static_cast<std::size_t>(*model)] + one_line(rest);
}

std::string one_line(const std::string& text) {
    std::string clean = text;
    for (char& c : clean)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
    return clean;
}

std::string shortened(const std::string& text, std::size_t most) {
    std::size_t characters = 0, end = 0;  // `end`: end of the last but one allowed character
    for (std::size_t i = 0; i < text.size(); ++i) {
        if ((text[i] & 0xC0) == 0x80) continue;  // not the first byte of a character
        if (++characters == most) end = i;
    }
    return characters <= most ? text : text.substr(0, end) + "…";
}

std::string three_digits(double value) {
    if (std::abs(value) < 99.95 || std::abs(value) >= 1e6) return fmt::format("{:.3g}", value);
    const double last = std::pow(10, std::floor(std::log10(std::abs(value)) + 1e-12) - 2);
    return fmt::format("{:.0f}", last * std::round(value / last));
}

StressUnit stress_unit(double largest) {
    if (largest >= 1e7) return {"MPa", 1e6};
    return largest >= 1e4 ? StressUnit{"kPa", 1e3} : StressUnit{"Pa", 1};
}

SeriesStyle reference_style() { return {"#000000", "o"}; }

SeriesStyle style_number(std::size_t index) {
    return {palette[index % palette.size()], markers[index % markers.size()]};
}

std::vector<SeriesStyle> styles_of(const std::vector<Setting>& settings) {
    std::set<ContactModel> models;
    for (const auto& setting : settings)
        if (const auto model = model_of(setting.replicas)) models.insert(*model);
    const bool by_model = models.size() == settings.size();
    const std::size_t count = settings.size();
    std::vector<SeriesStyle> styles;
    for (std::size_t s = 0; s < count; ++s) {
        styles.push_back(
            style_number(by_model ? static_cast<std::size_t>(*model_of(settings[s].replicas)) : s));
        if (!by_model && count > palette.size())
            styles.back().colour = ramp_colour(static_cast<double>(s) / static_cast<double>(count - 1));
    }
    return styles;
}

}  // namespace mcdem::report
