#include "report/page/labels.h"

#include <array>

#include "core/names.h"

namespace mcdem::inline report {
namespace {

constexpr std::array<const char*, Names<ContactModel>::list.size()> model_words{
    "Independent contacts", "Point force on sphere", "Sphere to sphere", "Elastic half space", "MC-DEM",
    "Elastic sphere",       "Hyperelastic sphere"};

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

StressUnit stress_unit(double largest) {
    if (largest >= 1e7) return {"MPa", 1e6};
    return largest >= 1e4 ? StressUnit{"kPa", 1e3} : StressUnit{"Pa", 1};
}

}  // namespace mcdem::report
