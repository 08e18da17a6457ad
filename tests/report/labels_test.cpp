#include "report/page/labels.h"

#include <gtest/gtest.h>

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

TEST(Shortened, counts_characters_not_bytes) {
    EXPECT_EQ(shortened("φφφφ", 4), "φφφφ");
    EXPECT_EQ(shortened("φφφφφ", 4), "φφφ…");
    EXPECT_EQ(shortened("abc", 10), "abc");
}

}  // namespace
}  // namespace mcdem
