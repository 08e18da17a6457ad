// [[species]] and [[pair]]: keys, defaults, and the assignment of species to grains.
#include "scene/species.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "scene/packing/make_packing.h"
#include "scene/packing/sizes.h"
#include "scene/programme/legs.h"
#include "scene/read/read_scene.h"
#include "scene_test_tools.h"

namespace mcdem {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string mixed_box =
    "[box]\nsize_x = 0.3\nsize_y = 0.3\n[plate]\nstart = 0.3\nend = 0.2\n"
    "[packing]\ncount = 2000\npacking_fraction = 0.4\ndiameter_mean = 0.02\ndiameter_sd = 0.001\n"
    "diameter_min = 0.017\ndiameter_max = 0.023\n[grains]\ndensity = 1000\nfriction = 0.4\nrestitution = "
    "0.9\n";
const std::string two =
    "[[species]]\nname = \"soft\"\nyoungs_modulus = 1e4\n[[species]]\nname = \"stiff\"\nyoungs_modulus = "
    "1e6\n"
    "poisson_ratio = 0.2\ndensity = 2500\nfriction = 0.1\nrestitution = 0.95\n";

Replica replica_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
    return parse_scene(mixed_box + text, "s.toml", overrides).replicas.front();
}
TEST(SpeciesOfAScene, DefaultsAreThoseOfGrains) {
    const Replica replica = replica_of(two, {"species.1.density=900"});
    ASSERT_EQ(replica.species.size(), 2u);
    const GrainMaterial &soft = replica.species[0].material, &stiff = replica.species[1].material;
    EXPECT_EQ(soft.density, 900);
    EXPECT_EQ(soft.friction, 0.4);
    EXPECT_EQ(soft.poisson_ratio, replica.grains.poisson_ratio);
    EXPECT_EQ(stiff.density, 2500);
    EXPECT_EQ(stiff.excess_density, replica.grains.excess_density);
    EXPECT_EQ(replica.species[0].fraction, 0.5);
    EXPECT_EQ(parameter_text(replica.parameters.at("species.2.youngs_modulus")), "1000000");
    EXPECT_EQ(parameter_text(replica.parameters.at("species.1.diameter_mean")), "0.02");
    EXPECT_EQ(parameter_text(replica.parameters.at("packing.diameter_mean")), "");
    EXPECT_TRUE(replica_of("").species.empty());
    EXPECT_FALSE(replica_of("").parameters.contains("species.1.name"));
    EXPECT_EQ(stiffest(replica).youngs_modulus, 1e6);
    EXPECT_EQ(softest(replica).youngs_modulus, 1e4);
}

TEST(SpeciesOfAScene, FrictionIsTheSmallerOneUnlessThePairGivesIt) {
    const Replica plain = replica_of(two);
    EXPECT_EQ(pair_law(plain, 0, 1).friction, 0.1);
    EXPECT_EQ(pair_law(plain, 1, 0).restitution, 0.9);
    EXPECT_EQ(pair_law(plain, 0, 0).friction, 0.4);
    EXPECT_EQ(wall_law(plain, 1).friction, plain.walls.friction);
    const Replica told = replica_of(two +
                                    "[[pair]]\nfirst = \"stiff\"\nsecond = \"soft\"\nfriction = 0.7\n"
                                    "[[pair]]\nfirst = \"stiff\"\nsecond = \"walls\"\nrestitution = 0.5\n");
    for (const auto& [a, b] : {std::pair(0, 1), std::pair(1, 0)}) {
        EXPECT_EQ(pair_law(told, a, b).friction, 0.7);
        EXPECT_EQ(pair_law(told, a, b).restitution, 0.9);
    }
    EXPECT_EQ(wall_law(told, 1).restitution, 0.5);
    EXPECT_EQ(wall_law(told, 1).friction, told.walls.friction);
    EXPECT_EQ(wall_law(told, 0).restitution, told.walls.restitution);
}

TEST(SpeciesOfAScene, VaryAndAreReadBackFromTheSceneText) {
    const Scene scene =
        parse_scene(mixed_box + two + "[batch.vary]\n\"species.1.poisson_ratio\" = [0.1, 0.3]\n", "s.toml",
                    {"species.1.fraction=0.25"});
    ASSERT_EQ(scene.replicas.size(), 2u);
    EXPECT_EQ(scene.replicas[0].species[0].material.poisson_ratio, 0.1);
    EXPECT_EQ(scene.replicas[1].species[1].fraction, 0.75);
    const Scene again = parse_scene(scene.text, "s.toml");
    EXPECT_EQ(again.replicas[1].parameters, scene.replicas[1].parameters);
    const Scene other = parse_scene(mixed_box + two, "s.toml", {"species=[{name = \"one\"}]"});
    EXPECT_EQ(other.replicas[0].species.size(), 1u);
}

TEST(SpeciesOfAScene, AreNoneOfADiagnosis) {
    EXPECT_THAT(
        problems_of([] { expect_plain_strokes(parse_scene(mixed_box + two, "s.toml"), "a diagnosis"); }),
        ElementsAre(HasSubstr("species: must be left out of a scene for a diagnosis")));
}

/// Diameters of one species, sorted.
std::vector<double> diameters(const Packing& packing, int species) {
    std::vector<double> found;
    for (std::size_t i = 0; i < packing.size(); ++i)
        if (packing.species[i] == species) found.push_back(packing.diameter[i]);
    std::ranges::sort(found);
    return found;
}

double filled_volume(const std::vector<double>& diameters) {
    double sum = 0;
    for (const double d : diameters) sum += d * d * d;
    return sum;
}

/// Kolmogorov-Smirnov distance from a distribution function.
template <class Distribution>
double distance(const std::vector<double>& sorted, const Distribution& below) {
    double most = 0;
    const auto count = static_cast<double>(sorted.size());
    for (std::size_t k = 0; k < sorted.size(); ++k) {
        const double share = below(sorted[k]), rank = static_cast<double>(k);
        most = std::max({most, std::abs(share - rank / count), std::abs(share - (rank + 1) / count)});
    }
    return most;
}

double normal_below(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

// One grain is drawn from each of n equally likely ranges, so the distance is at most 1/n; for independent
// draws it would be of the order of 1/sqrt(n).
TEST(GeneratedSpecies, HaveTheirSizeDistributions) {
    const TestFolder folder;
    const auto file =
        folder.write("sieve.csv", "# of a sieve\ngrain,diameter_m\n1,0.02\n2,0.022\n3,0.022\n4,0.03\n");
    const Replica replica = replica_of(fmt::format(
        "[[species]]\nname = \"normal\"\nfraction = 0.3\n"
        "[[species]]\nname = \"lognormal\"\nfraction = 0.4\nsizes = \"lognormal\"\ndiameter_mean = 0.015\n"
        "diameter_sd = 0.003\n[[species]]\nname = \"single\"\nfraction = 0.1\nsizes = \"single\"\n"
        "diameter_mean = 0.025\n[[species]]\nname = \"table\"\nsizes = \"table\"\ndiameter_file = \"{}\"\n",
        file.string()));
    const Packing packing = make_packing(replica);
    const auto normal = diameters(packing, 0), lognormal = diameters(packing, 1),
               single = diameters(packing, 2), table = diameters(packing, 3);
    EXPECT_EQ(normal.size(), 600u);
    EXPECT_EQ(lognormal.size(), 800u);
    EXPECT_EQ(single.size(), 200u);
    EXPECT_EQ(table.size(), 400u);
    const double low = normal_below(-3), high = normal_below(3);
    const auto cut = [&](double x) { return (normal_below(x) - low) / (high - low); };
    EXPECT_LE(distance(normal, [&](double d) { return cut((d - 0.02) / 0.001); }), 1.01 / 600);
    const double variance = std::log(1 + 0.04), mean = std::log(0.015) - variance / 2;
    const auto of_logarithm = [&](double d) { return cut((std::log(d) - mean) / std::sqrt(variance)); };
    EXPECT_LE(distance(lognormal, of_logarithm), 1.01 / 800);
    EXPECT_EQ(single.front(), 0.025);
    EXPECT_EQ(single.back(), 0.025);
    EXPECT_EQ(std::ranges::count(table, 0.02), 100);
    EXPECT_EQ(std::ranges::count(table, 0.022), 200);
    EXPECT_EQ(std::ranges::count(table, 0.03), 100);
    EXPECT_GT(distance(lognormal, [&](double d) { return normal_below((d - 0.015) / 0.003); }), 0.03)
        << "another law is told apart";
}

TEST(GeneratedSpecies, HaveTheirFractionsOfNumberOrVolume) {
    const std::string text =
        "[[species]]\nname = \"large\"\nfraction = 0.7\nsizes = \"single\"\n"
        "[[species]]\nname = \"small\"\ndiameter_mean = 0.01\ndiameter_sd = 0.0005\n";
    const Packing by_number = make_packing(replica_of(text));
    EXPECT_EQ(diameters(by_number, 0).size(), 1400u);
    const Packing by_volume = make_packing(replica_of(text, {"packing.fractions_by=volume"}));
    const double large = filled_volume(diameters(by_volume, 0)),
                 small = filled_volume(diameters(by_volume, 1));
    EXPECT_NEAR(large / (large + small), 0.7, 2e-3);
    EXPECT_EQ(by_volume.size(), 2000u);
}

/// Fraction of grains, in order of height, whose next grain is of another species: one half for two equal
/// fractions.
TEST(GeneratedSpecies, AreMixed) {
    const Packing packing = make_packing(replica_of(two));
    std::vector<std::size_t> order(packing.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::sort(order, {}, [&](std::size_t i) { return packing.position[i].z(); });
    int changes = 0;
    for (std::size_t k = 1; k < order.size(); ++k)
        changes += packing.species[order[k]] != packing.species[order[k - 1]];
    EXPECT_NEAR(changes / 2000.0, 0.5, 4 * 0.5 / std::sqrt(2000.0));
}

TEST(GeneratedSpecies, OneSpeciesGivesThePackingWithoutSpecies) {
    const Packing plain = make_packing(replica_of("")),
                  one = make_packing(replica_of("[[species]]\nname = \"a\"\n"));
    EXPECT_TRUE(plain.species.empty());
    EXPECT_EQ(one.diameter, plain.diameter);
    EXPECT_EQ(one.position, plain.position);
}

/// Four grains in the formats of several programs.
struct SpeciesFile {
    std::string name, text;
};
const std::vector<SpeciesFile> files_with_species{
    {"named.csv",
     "x_m,y_m,z_m,diameter_m,species\n.1,.1,.1,.02,stiff\n.2,.1,.1,.02,soft\n.1,.2,.1,.02,soft\n.2,.2,.1,.02,"
     "stiff\n"},
    {"typed.csv",
     "type,x_m,y_m,z_m,diameter_m\n2,.1,.1,.1,.02\n1,.2,.1,.1,.02\n1,.1,.2,.1,.02\n2,.2,.2,.1,.02\n"},
    {"grains.dump",
     "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n4\nITEM: ATOMS id type x y z radius\n4 2 .2 .2 .1 .01\n"
     "1 2 .1 .1 .1 .01\n2 1 .2 .1 .1 .01\n3 1 .1 .2 .1 .01\n"},
    {"grains.data",
     "title\n\n4 atoms\n\nAtoms # sphere\n\n4 2 .02 11.5 .2 .2 .1\n1 2 .02 11.5 .1 .1 .1\n"
     "2 1 .02 11.5 .2 .1 .1\n3 1 .02 11.5 .1 .2 .1\n"},
};
const std::string file_box = "[box]\nsize_x = 0.3\nsize_y = 0.3\n[plate]\nstart = 0.3\nend = 0.2\n";

TEST(SpeciesOfAFile, AreReadByNameOrNumber) {
    const TestFolder folder;
    for (const auto& [name, text] : files_with_species) {
        const std::string scene =
            file_box + fmt::format("[packing]\nfile = \"{}\"\n", folder.write(name, text).string());
        const Packing packing = make_packing(parse_scene(scene + two, "s.toml").replicas.front());
        EXPECT_THAT(packing.species, ElementsAre(1, 0, 0, 1)) << name;
        EXPECT_TRUE(make_packing(parse_scene(scene, "s.toml").replicas.front()).species.empty());
        EXPECT_THAT(problems_of([&] { parse_scene(scene + two, "s.toml", {"species.1.fraction=0.5"}); }),
                    Contains(HasSubstr("the fractions of [[species]] must be left out")));
        EXPECT_THAT(problems_of([&] {
                        parse_scene(scene + two, "s.toml",
                                    {"species=[{name = \"soft\"}, {name = \"b\"}, {name = \"c\"}]",
                                     name == "named.csv" ? "name=x" : "species.9.name=x"});
                    }),
                    Contains(HasSubstr(name == "named.csv"
                                           ? "a grain's species must be one of [[species]] (soft or 1, "
                                             "b or 2, c or 3), got \"stiff\""
                                           : "species.9.name")));
    }
}

TEST(SpeciesOfAFile, FollowTheFractionsIfTheFileHasNoNames) {
    const TestFolder folder;
    std::string rows = "x_m,y_m,z_m,diameter_m\n";
    for (int i = 0; i < 400; ++i)
        rows += fmt::format("{},{},{},{}\n", 0.01 + 0.014 * (i % 20), 0.01 + 0.014 * (i / 20), 0.1,
                            i % 2 ? 0.012 : 0.006);
    const std::string scene =
        file_box + fmt::format("[packing]\nfile = \"{}\"\n", folder.write("plain.csv", rows).string()) + two;
    EXPECT_THAT(problems_of([&] { parse_scene(scene, "s.toml"); }),
                ElementsAre(HasSubstr("must say of each grain which species it is")));
    const auto drawn = [&](std::vector<std::string> overrides) {
        overrides.push_back("species.1.fraction=0.3");
        return make_packing(parse_scene(scene, "s.toml", overrides).replicas.front());
    };
    EXPECT_EQ(std::ranges::count(drawn({}).species, 0), 120);
    EXPECT_EQ(drawn({}).species, drawn({}).species);
    EXPECT_NE(drawn({}).species, drawn({"packing.seed=2"}).species);
    const Packing by_volume = drawn({"packing.fractions_by=volume"});
    const double soft = filled_volume(diameters(by_volume, 0)),
                 stiff = filled_volume(diameters(by_volume, 1));
    EXPECT_NEAR(soft / (soft + stiff), 0.3, 0.5 / 225) << "to half a grain of the 225 large ones' volume";
}

TEST(SpeciesCounts, AddUpByTheLargestRemainderMethod) {
    EXPECT_THAT(apportion(10, {0.25, 0.25, 0.5}), ElementsAre(3, 2, 5));
    EXPECT_THAT(apportion(7, {1, 1}), ElementsAre(4, 3));
    EXPECT_THAT(apportion(3, {0.9, 0.05, 0.05}), ElementsAre(3, 0, 0));
}

}  // namespace
}  // namespace mcdem
