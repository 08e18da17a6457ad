#include "report/gnuplot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "core/errors.h"
#include "report/folder.h"

namespace mcdem {
namespace {

using testing::HasSubstr;

TEST(Gnuplot, quoting_leaves_no_way_out) {
    EXPECT_EQ(gnuplot::quoted("plain"), "'plain'");
    EXPECT_EQ(gnuplot::quoted("it's"), "'it''s'");
    EXPECT_EQ(gnuplot::quoted("a\nb\\"), "'a b\\'");
}

TEST(Gnuplot, csv_fields) {
    EXPECT_EQ(gnuplot::csv_field("mc_dem"), "mc_dem");
    EXPECT_EQ(gnuplot::csv_field("a, \"b\""), "\"a, \"\"b\"\"\"");
    EXPECT_EQ(gnuplot::csv_number(1.5), "1.5");
    EXPECT_EQ(gnuplot::csv_number(std::nan("")), "");
}

TEST(Gnuplot, what_it_says_comes_with_the_error) {
    const TestFolder folder;
    std::ofstream(folder.path / "bad.gp") << "plot 'missing_file.csv'\n";
    try {
        gnuplot::run(folder.path, "bad.gp");
        FAIL() << "a bad script must be told";
    } catch (const RunError& error) {
        EXPECT_THAT(error.what(), HasSubstr("missing_file.csv"));
    }
}

TEST(Gnuplot, missing_program_names_the_package) {
    const TestFolder folder;
    const std::string path = std::getenv("PATH");
    ::setenv("PATH", folder.path.c_str(), 1);
    std::string told;
    try {
        gnuplot::run(folder.path, "any.gp");
    } catch (const RunError& error) {
        told = error.what();
    }
    ::setenv("PATH", path.c_str(), 1);
    EXPECT_THAT(told, HasSubstr("apt install gnuplot-nox"));
}

}  // namespace
}  // namespace mcdem
