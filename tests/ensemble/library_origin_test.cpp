// What a library depends on, by name.
#include "ensemble/diagnosis/library_origin.h"

#include <gmock/gmock.h>

#include <set>

#include "ensemble/small_trials.h"
#include "scene/read/keys.h"

namespace mcdem {
namespace {

class LibraryOrigin : public ::testing::Test {
protected:
    std::map<std::string, std::string> origin() const { return library_origin(common, model, grains); }
    /// Names whose values differ after the change.
    template <class Change>
    std::set<std::string> changed_by(Change change) {
        const auto before = std::tuple{common, model, grains};
        const std::map<std::string, std::string> first = origin();
        change();
        std::set<std::string> names;
        for (const auto& [name, value] : origin())
            if (first.at(name) != value) names.insert(name);
        std::tie(common, model, grains) = before;
        return names;
    }

    SmallTrials small;
    TrialSettings common = small.common;
    Model model = small.model;
    std::size_t grains = 100;
};

TEST_F(LibraryOrigin, ContainsEveryKeyOfAReplicaExceptThoseOfThePacking) {
    for (const Key& key : keys())
        if (key.scope == Scope::replica) {
            EXPECT_EQ(origin().contains(std::string(key.name)), !key.name.starts_with("packing."))
                << key.name;
        }
}

TEST_F(LibraryOrigin, ContainsInstrumentGrainsPrecisionVersionAndKernels) {
    using Names = std::set<std::string>;
    Measurement& stated = model.instrument.stated;
    EXPECT_EQ(changed_by([&] { stated.position_error += 1e-3; }), Names{"measurement.position_error"});
    EXPECT_EQ(changed_by([&] { stated.diameter_error += 1e-3; }), Names{"measurement.diameter_error"});
    EXPECT_EQ(changed_by([&] { stated.force_error += 0.01; }), Names{"measurement.force_error"});
    EXPECT_EQ(changed_by([&] { stated.force_threshold += 0.01; }), Names{"measurement.force_threshold"});
    EXPECT_EQ(changed_by([&] { common.scene.precision = Precision::double_precision; }),
              Names{"numerics.precision"});
    EXPECT_EQ(changed_by([&] { common.program = "99.0 (abc)"; }), Names{"program"});
    EXPECT_EQ(changed_by([&] { model.mean_diameter *= 2; }), Names{"mean diameter"});
    EXPECT_EQ(changed_by([&] { grains = 150; }), Names{"grains"});
    EXPECT_EQ(changed_by([&] { model.replica.grains.friction = 0.9; }), Names{"grains.friction"});
    EXPECT_EQ(changed_by([&] { model.replica.packing.seed += 1; }), Names{}) << "of the packing";
    EXPECT_EQ(origin().at("kernels").size(), 64u);
}

TEST_F(LibraryOrigin, OfAProgramIsItsVersionWithoutTheCommit) {
    common.program = "0.2.0 (abc)";
    EXPECT_EQ(origin().at("program"), "0.2.0");
}

}  // namespace
}  // namespace mcdem
