#include "report/page/labels.h"

#include <fmt/format.h>

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
    return std::abs(value) < 99.95 || std::abs(value) >= 1e6 ? fmt::format("{:.3g}", value)
                                                             : fmt::format("{:.0f}", value);
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
    std::vector<SeriesStyle> styles;
    for (std::size_t s = 0; s < settings.size(); ++s)
        styles.push_back(
            style_number(by_model ? static_cast<std::size_t>(*model_of(settings[s].replicas)) : s));
    return styles;
}

}  // namespace mcdem::report
