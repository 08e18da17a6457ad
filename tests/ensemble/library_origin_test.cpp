// A library is accepted only with the scene, instrument and program from which it was made.
#include "ensemble/diagnosis/library_origin.h"

#include <gmock/gmock.h>

#include "core/errors.h"
#include "ensemble/small_trials.h"
#include "metrics/estimate.h"
#include "scene/read/keys.h"

namespace mcdem {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class LibraryOrigin : public ::testing::Test {
protected:
    std::map<std::string, std::string> origin() const { return library_origin(common, model, grains); }
    void expect_refused(const std::string& problem) const {
        EXPECT_THAT(
            [&] { expect_origin(library, origin(), "file.json"); },
            ThrowsMessage<InputError>(testing::AllOf(HasSubstr("file.json: was made with " + problem),
                                                     HasSubstr("give another file name for --library"))));
    }
    void expect_taken() const { EXPECT_NO_THROW(expect_origin(library, origin(), "file.json")); }

    SmallTrials small;
    TrialSettings common = small.common;
    Model model = small.model;
    std::size_t grains = 100;
    Library library = [this] {
        Library made;
        made.origin = origin();
        return made;
    }();
};

TEST_F(LibraryOrigin, DifferingKeysAreNamedWithBothValues) {
    expect_taken();
    model.replica.grains.friction = 0.9;
    model.replica.contact.model = ContactModel::point_force_on_sphere;
    expect_refused("grains.friction = ");
    expect_refused("contact.model = ");
    EXPECT_THAT([&] { expect_origin(library, origin(), "file.json"); },
                ThrowsMessage<InputError>(HasSubstr("needed is 0.9")));
}

TEST_F(LibraryOrigin, ContainsEveryKeyOfAReplicaExceptThoseOfThePacking) {
    for (const Key& key : keys())
        if (key.scope == Scope::replica) {
            EXPECT_EQ(origin().contains(std::string(key.name)), !key.name.starts_with("packing."))
                << key.name;
        }
}

TEST_F(LibraryOrigin, InstrumentPrecisionVersionAndKernelsMustBeTheSame) {
    const auto only = [&](auto change, const std::string& problem) {
        const auto before = std::pair{common, model};
        change();
        expect_refused(problem);
        std::tie(common, model) = before;
    };
    only(
        [&] {
            model.instrument.stated.force_error *= 2;
            model.instrument.stated.force_error += 0.01;
        },
        "measurement.force_error");
    only([&] { model.instrument.stated.position_error += 1e-3; }, "measurement.position_error");
    only([&] { common.scene.precision = Precision::double_precision; }, "numerics.precision");
    only([&] { common.program = "99.0 (abc)"; }, "program");
    library.origin["kernels"] = "others";
    expect_refused("kernels = others");
}

TEST_F(LibraryOrigin, DataOfTheExperimentMayDiffer) {
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

TEST_F(LibraryOrigin, LibrariesWithoutOriginAreRefused) {
    library.origin.clear();
    expect_refused("grains.friction = nothing");
}

TEST_F(LibraryOrigin, PackingsHaveTheLoadOfTheExperiments) {
    library.grid = {{0.01, 0.02}, 0.005, 0.022};
    const std::vector<Cell> cells = cells_of(library.grid);
    library.baseline = Eigen::MatrixXd::Constant(3, static_cast<Eigen::Index>(cells.size()), 0.5);
    const auto at_times_the_load = [&](double times) {
        Eigen::MatrixXd baseline = library.baseline;
        for (std::size_t k = 0; k < cells.size(); ++k)
            if (observables()[static_cast<std::size_t>(cells[k].observable)].name == "top_force")
                baseline.col(static_cast<Eigen::Index>(k)).array() +=
                    cells[k].phase == Phase::load ? std::log(times) : 3;
        baseline(0, 0) = not_available;
        expect_alike_loads(library, baseline, "file.json");
    };
    for (const double times : {0.8, 1.0, 1.3}) EXPECT_NO_THROW(at_times_the_load(times));
    EXPECT_THAT([&] { at_times_the_load(1.9); },
                ThrowsMessage<InputError>(testing::AllOf(HasSubstr("file.json: at the same displacements"),
                                                         HasSubstr("carries 1.90 times the load"))));
    EXPECT_THROW(at_times_the_load(0.5), InputError);
}

}  // namespace
}  // namespace mcdem
