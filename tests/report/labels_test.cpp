#include "report/page/labels.h"

#include <gtest/gtest.h>

#include <set>

namespace mcdem {
namespace {

TEST(WordsFor, models_are_described_and_other_values_kept) {
    EXPECT_EQ(words_for("mc_dem"), "MC-DEM");
    EXPECT_EQ(words_for("mc_dem, gamma = 1.2"), "MC-DEM, gamma = 1.2");
    EXPECT_EQ(words_for("elastic_sphere"), "Elastic sphere");
    EXPECT_EQ(words_for("hyperelastic_sphere"), "Hyperelastic sphere");
    EXPECT_EQ(words_for("gamma = 1"), "gamma = 1");
    EXPECT_EQ(words_for("mc_demented"), "mc_demented");
    EXPECT_EQ(words_for(""), "");
}

TEST(OneLine, control_characters_become_spaces) {
    EXPECT_EQ(one_line("a\nb\x1b[2Jc\td\x7f"), "a b [2Jc d ");
    EXPECT_EQ(one_line("⟨Z⟩ ±"), "⟨Z⟩ ±");
}

TEST(ThreeDigits, have_no_exponent_in_ordinary_numbers) {
    EXPECT_EQ(three_digits(0.01234), "0.0123");
    EXPECT_EQ(three_digits(99.94), "99.9");
    EXPECT_EQ(three_digits(999.9), "1000");
    EXPECT_EQ(three_digits(-5881), "-5880");
    EXPECT_EQ(three_digits(1000), "1000");
    EXPECT_EQ(three_digits(2.5e7), "2.5e+07");
}

TEST(StylesOf, many_settings_have_different_colours) {
    std::vector<Setting> settings(40);
    std::set<std::string> colours;
    for (const SeriesStyle& style : styles_of(settings)) colours.insert(style.colour);
    EXPECT_EQ(colours.size(), 40u);
    EXPECT_EQ(colours.count("#440154"), 1u) << "the first end of the ramp";
}

TEST(Shortened, counts_characters_not_bytes) {
    EXPECT_EQ(shortened("φφφφ", 4), "φφφφ");
    EXPECT_EQ(shortened("φφφφφ", 4), "φφφ…");
    EXPECT_EQ(shortened("abc", 10), "abc");
}

}  // namespace
}  // namespace mcdem
