// The plan of a challenge: drawn from one seed, with the given numbers, amplitudes and an even distribution.
#include "challenge/plan.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "challenge/outside.h"
#include "challenge/truth.h"
#include "core/errors.h"

namespace mcdem {
namespace {

Model model() {
    Model m;
    m.replica.contact.model = ContactModel::independent;
    m.mean_diameter = 0.02;
    return m;
}

std::vector<std::string> all_tried() { return {challenged_effects().begin(), challenged_effects().end()}; }

Challenge draw(std::uint64_t seed, const ChallengeSize& size = {},
               const std::vector<std::string>& effects = all_tried()) {
    const Model m = model();
    return draw_challenge(size, effects, m, nuisances(m, {}), "scene", seed);
}

std::vector<ChallengeCase> of_kind(const Challenge& challenge, CaseKind kind) {
    std::vector<ChallengeCase> list;
    std::ranges::copy_if(challenge.cases, std::back_inserter(list),
                         [&](const auto& c) { return c.kind == kind; });
    return list;
}

double prior(const std::string& name) {
    const Model m = model();
    for (const Nuisance& nuisance : nuisances(m, {}))
        if (nuisance.name == name) return nuisance.sigma;
    return NAN;
}

TEST(ChallengePlan, OneSeedGivesOneChallenge) {
    EXPECT_EQ(draw(5), draw(5));
    EXPECT_EQ(truth_text(draw(5)), truth_text(draw(5)));
    EXPECT_NE(seal_of(truth_text(draw(5))), seal_of(truth_text(draw(6))));
}

TEST(ChallengePlan, HasTheGivenNumberOfEachKind) {
    const Challenge challenge = draw(1);
    EXPECT_GE(all_tried().size(), 10u);
    EXPECT_EQ(of_kind(challenge, CaseKind::none).size(), 60u);
    EXPECT_EQ(of_kind(challenge, CaseKind::effect).size(), 8 * all_tried().size());
    EXPECT_EQ(of_kind(challenge, CaseKind::pair).size(), 20u);
    EXPECT_EQ(of_kind(challenge, CaseKind::unknown).size(), 40u);
    EXPECT_EQ(of_kind(challenge, CaseKind::outside_prior).size(), 20u);
    EXPECT_EQ(challenge.packing_seeds.size(), 24u);
    EXPECT_EQ(std::set(challenge.packing_seeds.begin(), challenge.packing_seeds.end()).size(), 24u);
    EXPECT_EQ(challenge.cases.front().folder, "case_0001");
}

TEST(ChallengePlan, AmplitudesSpanTheRangeOfTheLibrary) {
    const Model m = model();
    ChallengeSize size;
    size.per_effect = 40;
    for (const ChallengeCase& c : of_kind(draw(2, size), CaseKind::effect)) {
        const Effect& effect = *find_effect(c.effects.at(0).name);
        const double scale = effect.scale(m), first = std::abs(effect.first),
                     second = std::abs(effect.second);
        const double over = std::abs(c.effects[0].amplitude) / scale;
        EXPECT_GE(over, 0.1 * first * (1 - 1e-9)) << effect.name;
        EXPECT_LE(over, 1.5 * second * (1 + 1e-9)) << effect.name;
        EXPECT_GE(c.effects[0].amplitude, effect.low * scale) << effect.name;
        EXPECT_LE(c.effects[0].amplitude, effect.high * scale) << effect.name;
    }
}

TEST(ChallengePlan, SignsAreRandomIfBothArePlausible) {
    ChallengeSize size;
    size.per_effect = 40;
    std::map<std::string, std::set<bool>> signs;
    for (const ChallengeCase& c : of_kind(draw(3, size), CaseKind::effect))
        signs[c.effects[0].name].insert(c.effects[0].amplitude > 0);
    EXPECT_EQ(signs["plate_tilt"].size(), 2u);
    EXPECT_EQ(signs["diameter_error"].size(), 2u);
    EXPECT_EQ(signs["adhesion"], std::set{true});
    EXPECT_EQ(signs["friction"],
              std::set{true});  // -1 is the lower bound, and smaller than the library's own amplitudes
}

TEST(ChallengePlan, PairsAreTwoDifferentEffects) {
    for (const ChallengeCase& c : of_kind(draw(4), CaseKind::pair)) {
        ASSERT_EQ(c.effects.size(), 2u);
        EXPECT_NE(c.effects[0].name, c.effects[1].name);
    }
}

TEST(ChallengePlan, UnknownEffectsAreNotInTheLibraryOfTheirDiagnosis) {
    std::set<std::string> outside;
    int struck = 0;
    for (const ChallengeCase& c : of_kind(draw(5), CaseKind::unknown)) {
        const std::string& name = c.effects.at(0).name;
        if (c.struck.empty()) {
            ASSERT_TRUE(find_outside_effect(name)) << name;
            EXPECT_FALSE(find_effect(name)) << name;
            outside.insert(name);
        } else {
            EXPECT_THAT(c.struck, testing::Contains(name));
            if (name == "plate_tilt") {
                EXPECT_THAT(c.struck, testing::Contains("plate_tilt_y"));
            }
            ++struck;
        }
    }
    EXPECT_EQ(outside.size(), outside_effects().size());
    EXPECT_EQ(struck, 10);
}

TEST(ChallengePlan, NuisancesAreDrawnFromTheirPriorsOrFarOutside) {
    double square = 0;
    int count = 0, far = 0;
    for (const ChallengeCase& c : draw(6).cases)
        for (const Hidden& shift : c.nuisances) {
            const double sigmas = std::abs(shift.amplitude) / prior(shift.name);
            if (c.kind == CaseKind::outside_prior && sigmas >= 4) {
                EXPECT_LE(sigmas, 8);
                ++far;
            } else {
                square += sigmas * sigmas;
                ++count;
            }
        }
    EXPECT_EQ(far, 20);
    EXPECT_NEAR(square / count, 1, 4 * std::sqrt(2.0 / count));  // chi-square, four sigmas
}

TEST(ChallengePlan, EveryKindIsInBothHalves) {
    std::map<std::string, std::array<int, 2>> dealt;
    std::array<int, 24> by_packing{};
    for (const ChallengeCase& c : draw(7).cases) {
        const std::string what = c.kind == CaseKind::effect ? c.effects[0].name : std::string(name(c.kind));
        ++dealt[what][in_first_half(c.packing)];
        ++by_packing[static_cast<std::size_t>(c.packing)];
    }
    for (const auto& [what, halves] : dealt) EXPECT_LE(std::abs(halves[0] - halves[1]), 1) << what;
    const auto [fewest, most] = std::ranges::minmax(by_packing);
    EXPECT_LE(most - fewest, 1);
}

TEST(ChallengePlan, OrderIsRandom) {
    // Mean position of the cases without an effect: the middle, within four standard errors.
    const Challenge challenge = draw(8);
    double sum = 0;
    int count = 0;
    for (std::size_t k = 0; k < challenge.cases.size(); ++k)
        if (challenge.cases[k].kind == CaseKind::none) sum += static_cast<double>(k), ++count;
    const double n = static_cast<double>(challenge.cases.size());
    EXPECT_NEAR(sum / count, (n - 1) / 2, 4 * n / std::sqrt(12.0 * count));
}

TEST(ChallengePlan, InvalidOptionsAreReported) {
    ChallengeSize size;
    size.packings = 3;
    size.pairs = -1;
    EXPECT_THAT(
        [&] {
            draw(1, size, {"friction", "magic"});
        },
        testing::ThrowsMessage<InputError>(
            testing::AllOf(testing::HasSubstr("--packings must be an even number"),
                           testing::HasSubstr("--pairs must be 0 or more, got -1"),
                           testing::HasSubstr("magic is not an effect"))));
}

TEST(ChallengeTruth, IsReadBackAsWritten) {
    const Challenge challenge = draw(9);
    EXPECT_EQ(parse_truth(truth_text(challenge), "truth.json"), challenge);
}

Recording two_scans() {
    Recording recording;
    recording.scans.resize(2);
    for (Scan& scan : recording.scans) {
        scan.plate_z = 0.1;
        scan.position = {{0.01, 0.02, 0.04}};
        scan.contacts = {{0, wall_partner(Wall::floor), {0.01, 0.02, 0.04}, {0, 0, 1}, 0}};
        scan.wall_force[static_cast<int>(Wall::plate)] = {0, 0, 2};
    }
    recording.scans[1].phase = Phase::unload;
    return recording;
}

TEST(OutsideEffects, ChangeTheMeasurementAsDescribed) {
    Recording stretched = two_scans();
    find_outside_effect("vertical_stretch")->change_reading(stretched, 0.01);
    EXPECT_NEAR(stretched.scans[1].position[0].z(), 0.0404, 1e-15);
    EXPECT_NEAR(stretched.scans[1].contacts[0].point.z(), 0.0404, 1e-15);
    EXPECT_EQ(stretched.scans[1].position[0].x(), 0.01);
    EXPECT_EQ(stretched.scans[1].plate_z, 0.1);
    Recording loose = two_scans();
    find_outside_effect("plate_backlash")->change_reading(loose, 1e-3);
    EXPECT_EQ(loose.scans[0].plate_z, 0.1);
    EXPECT_NEAR(loose.scans[1].plate_z, 0.101, 1e-15);
}

TEST(OutsideEffects, ChangeTheModelAsDescribed) {
    Replica replica;
    find_outside_effect("soft_walls")->change_model(replica, 2);
    EXPECT_EQ(replica.walls.youngs_modulus, 2 * replica.grains.youngs_modulus);
    const double size = replica.box.size_x;
    find_outside_effect("box_error")->change_model(replica, 0.01);
    EXPECT_NEAR(replica.box.size_x, 0.99 * size, 1e-15);
}

}  // namespace
}  // namespace mcdem
