#include "metrics/law_range.h"

#include <gtest/gtest.h>

#include "metrics/synthetic.h"

namespace mcdem {
namespace {

/// Two scans of loading with these largest overlaps.
Recording pressed(const std::string& model, double first, double second) {
    Recording made = synthetic::recording({.model = model, .levels = 2});
    made.scans.resize(2);
    made.scans[0].max_overlap = first;
    made.scans[1].max_overlap = second;
    return made;
}

TEST(LawRange, IsExceededAtTheFirstScanWithALargerOverlap) {
    const Recording within = pressed("hyperelastic_sphere", 0.1, 0.19);
    const Recording late = pressed("hyperelastic_sphere", 0.1, 0.27),
                    early = pressed("hyperelastic_sphere", 0.21, 0.25);
    EXPECT_FALSE(beyond_law({&within}));
    auto beyond = beyond_law({&within, &late});
    ASSERT_TRUE(beyond);
    EXPECT_EQ(beyond->tested, 0.20);
    EXPECT_NEAR(beyond->displacement, late.displacement(late.scans[1]), 1e-12);
    beyond = beyond_law({&late, &early});
    EXPECT_NEAR(beyond->displacement, early.displacement(early.scans[0]), 1e-12);
    EXPECT_EQ(beyond->max_overlap, 0.27);
}

TEST(LawRange, IsSmallerAtSmallStrainAndUnknownForOtherModels) {
    const Recording elastic = pressed("elastic_sphere", 0.05, 0.12), hertz = pressed("independent", 0.2, 0.3);
    EXPECT_TRUE(beyond_law({&elastic}));
    EXPECT_FALSE(beyond_law({&hertz}));
}

TEST(LawRange, IsNotCheckedIfOverlapsAreUnknown) {
    const Recording unknown = synthetic::recording({.model = "elastic_sphere"});
    EXPECT_FALSE(beyond_law({&unknown}));
}

}  // namespace
}  // namespace mcdem
