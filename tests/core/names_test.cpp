#include "core/names.h"

#include <gtest/gtest.h>

#include <set>

namespace mcdem {
namespace {

template <class Enum>
class NamesTest : public testing::Test {};
using Sets = testing::Types<ContactModel, FrictionLaw, Wall, Phase, Precision>;
TYPED_TEST_SUITE(NamesTest, Sets);

TYPED_TEST(NamesTest, EveryWordIsReadBackAsItself) {
    const auto& list = name_list<TypeParam>;
    for (std::size_t i = 0; i < list.size(); ++i) {
        const auto value = parse<TypeParam>(list[i]);
        ASSERT_TRUE(value.has_value()) << list[i];
        EXPECT_EQ(static_cast<std::size_t>(*value), i);
        EXPECT_EQ(name(*value), list[i]);
    }
}

TYPED_TEST(NamesTest, NoWordHasTwoValues) {
    const auto& list = name_list<TypeParam>;
    EXPECT_EQ(std::set(list.begin(), list.end()).size(), list.size());
}

TYPED_TEST(NamesTest, OtherWordsAreRefused) {
    const std::string first(name_list<TypeParam>[0]);
    for (const std::string& word : {std::string(), first + " ", " " + first, first + "s", first.substr(1)})
        EXPECT_FALSE(parse<TypeParam>(word).has_value()) << '"' << word << '"';
}

TEST(Names, WordsGiveTheirValues) {
    EXPECT_EQ(name(ContactModel::independent), "independent");
    EXPECT_EQ(name(ContactModel::point_force_on_sphere), "point_force_on_sphere");
    EXPECT_EQ(name(ContactModel::sphere_to_sphere), "sphere_to_sphere");
    EXPECT_EQ(name(ContactModel::elastic_half_space), "elastic_half_space");
    EXPECT_EQ(name(ContactModel::mc_dem), "mc_dem");
    EXPECT_EQ(name(ContactModel::elastic_sphere), "elastic_sphere");
    EXPECT_EQ(name(FrictionLaw::mindlin), "mindlin");
    EXPECT_EQ(name(Wall::floor), "floor");
    EXPECT_EQ(name(Wall::plate), "plate");
    EXPECT_EQ(name(Phase::unload), "unload");
    EXPECT_EQ(name(Precision::double_precision), "double");
    EXPECT_EQ(name_list<Wall>.size(), static_cast<std::size_t>(wall_count));
}

TEST(Names, ListForMessages) {
    EXPECT_EQ(all_names<FrictionLaw>(), "saturated, mindlin, mindlin_displacement");
}

}  // namespace
}  // namespace mcdem
