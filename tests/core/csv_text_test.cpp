#include "core/csv_text.h"

#include <gtest/gtest.h>

namespace mcdem::test {
namespace {

TEST(CsvText, CellsNeverStartAFormula) {
    for (const std::string formula : {"=1+1", "+cmd|' /C calc'!A0", "-1+1", "@SUM(A1)", "\t=1", " =1", "\r=1",
                                      "\"=1", "-0.5, mc_dem", "="}) {
        const std::string cell = csv_cell(formula);
        EXPECT_EQ(cell.substr(0, 2), "\"'") << formula;
        EXPECT_EQ(cell.back(), '"');
    }
}

TEST(CsvText, OtherTextAndNumbersStay) {
    for (const std::string text :
         {"mc_dem", "gamma=1.125", "-0.5", "+3", "1e-3", "-1.5e+07", "", "a=b", "'quoted'"})
        EXPECT_EQ(csv_cell(text), '"' + text + '"');
    EXPECT_EQ(csv_cell("a \"b\"\nc"), "\"a \"\"b\"\" c\"");
    EXPECT_TRUE(is_number("-1.5e+07"));
    for (const std::string text : {"", "-", "1 ", "nan", "inf", "0x10", "1.5.2", "-1+1"})
        EXPECT_FALSE(is_number(text));
}

}  // namespace
}  // namespace mcdem::test
