#include "report/page/series_style.h"

#include <array>
#include <set>

namespace mcdem::inline report {
namespace {

// Okabe & Ito 2008, without yellow (too light on white) and black (the reference), in the order of
// ContactModel.
constexpr std::array<const char*, 7> palette{"#0072B2", "#56B4E9", "#009E73", "#E69F00",
                                             "#D55E00", "#CC79A7", "#666666"};
constexpr std::array<const char*, 7> markers{"s", "^", "v", "D", "o", "p", "h"};

}  // namespace

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
