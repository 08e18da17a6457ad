// A library is taken for what it was made from, and for nothing else.
#include "ensemble/library_origin.h"

#include <gmock/gmock.h>

#include "core/errors.h"
#include "ensemble/small_trials.h"
#include "scene/keys.h"

namespace mcdem {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class LibraryOrigin : public ::testing::Test {
protected:
    std::map<std::string, std::string> origin() const { return library_origin(question, model, grains); }
    void expect_refused(const std::string& problem) const {
        EXPECT_THAT([&] { expect_origin(library, origin(), "file.json"); },
                    ThrowsMessage<InputError>(testing::AllOf(HasSubstr("file.json: was made with " + problem),
                                                             HasSubstr("give another file for --library"))));
    }
    void expect_taken() const { EXPECT_NO_THROW(expect_origin(library, origin(), "file.json")); }

    SmallTrials small;
    Question question = small.question;
    Model model = small.model;
    std::size_t grains = 100;
    Library library = [this] {
        Library made;
        made.origin = origin();
        return made;
    }();
};

TEST_F(LibraryOrigin, KeysOfTheSceneAreNamedWithBothValues) {
    expect_taken();
    model.replica.grains.friction = 0.9;
    model.replica.contact.model = ContactModel::point_force_on_sphere;
    expect_refused("grains.friction = ");
    expect_refused("contact.model = ");
    EXPECT_THAT([&] { expect_origin(library, origin(), "file.json"); },
                ThrowsMessage<InputError>(HasSubstr("needed is 0.9")));
}

TEST_F(LibraryOrigin, EveryKeyOfAReplicaIsInItButThoseOfThePacking) {
    for (const Key& key : keys())
        if (key.scope == Scope::replica) {
            EXPECT_EQ(origin().contains(std::string(key.name)), !key.name.starts_with("packing."))
                << key.name;
        }
}

TEST_F(LibraryOrigin, InstrumentPrecisionVersionAndKernelsMustBeTheSame) {
    const auto only = [&](auto change, const std::string& problem) {
        const auto before = std::pair{question, model};
        change();
        expect_refused(problem);
        std::tie(question, model) = before;
    };
    only(
        [&] {
            model.instrument.stated.force_error *= 2;
            model.instrument.stated.force_error += 0.01;
        },
        "measurement.force_error");
    only([&] { model.instrument.stated.position_error += 1e-3; }, "measurement.position_error");
    only([&] { question.scene.precision = Precision::double_precision; }, "numerics.precision");
    only([&] { question.program = "99.0 (abc)"; }, "program");
    library.origin["kernels"] = "others";
    expect_refused("kernels = others");
}

TEST_F(LibraryOrigin, WhatExperimentsBringMayDiffer) {
    model.replica.packing.seed += 1;
    model.replica.plate.start += 1e-3;
    model.replica.plate.end += 1e-3;
    model.replica.protocol.scans_per_stroke += 1;
    model.replica.box.size_x *= 1.05;
    model.mean_diameter *= 0.95;
    grains = 105;
    expect_taken();
    grains = 150;
    expect_refused("grains = 100, needed is 150");
    grains = 100;
    model.mean_diameter *= 2;
    expect_refused("mean diameter");
}

TEST_F(LibraryOrigin, WithoutOneNothingIsTaken) {
    library.origin.clear();
    expect_refused("grains.friction = nothing");
}

}  // namespace
}  // namespace mcdem
