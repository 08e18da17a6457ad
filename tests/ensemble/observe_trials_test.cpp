// Trials: the same results alone and in a batch, new and from the store; different trials have different
// names.
#include "ensemble/diagnosis/observe_trials.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <thread>

#include "ensemble/small_trials.h"
#include "scene/read/keys.h"

namespace mcdem {
namespace {

TEST(ObserveTrials, AreTheSameAloneAndInABatch) {
    const SmallTrials small;
    Device device;
    Trial tilted = small.trial(2), biased = small.trial(3);
    tilted.model.replica.effects.plate_tilt_x = 0.01;
    biased.model.instrument.force_bias = 0.2;
    const std::vector<Trial> trials{small.trial(1), tilted, biased};
    const Eigen::MatrixXd together = observe_trials(device, small.common, trials, small.store, {});
    ASSERT_EQ(together.rows(), 3);
    ASSERT_EQ(together.cols(), static_cast<Eigen::Index>(bins_of(small.common.grid).size()));
    EXPECT_TRUE(std::isfinite(together(0, 0)) && std::isfinite(together(0, 1)));
    EXPECT_NE(together(0, 1), together(1, 1));
    for (std::size_t k = 0; k < 3; ++k) {
        const SmallTrials fresh;
        const auto alone = observe_trials(device, fresh.common, {trials[k]}, fresh.store, {});
        EXPECT_TRUE(same(alone.row(0), together.row(static_cast<Eigen::Index>(k)))) << k;
    }
}

/// Counts the calls of progress: zero if nothing is simulated.
struct Watched {
    int calls = 0;
    Callbacks options() {
        Callbacks o;
        o.on_progress = [this](double fraction) {
            ++calls;
            EXPECT_GE(fraction, 0);
            EXPECT_LE(fraction, 1);
        };
        return o;
    }
};

TEST(ObserveTrials, StoredTrialsAreNotSimulated) {
    const SmallTrials small;
    Device device;
    Watched first, second, third;
    const auto fresh = observe_trials(device, small.common, {small.trial(1)}, small.store, first.options());
    EXPECT_GT(first.calls, 0);
    const auto kept = observe_trials(device, small.common, {small.trial(1)}, small.store, second.options());
    EXPECT_EQ(second.calls, 0);
    EXPECT_TRUE(same(kept.row(0), fresh.row(0)));
    const auto more =
        observe_trials(device, small.common, {small.trial(2), small.trial(1)}, small.store, third.options());
    EXPECT_GT(third.calls, 0);
    EXPECT_TRUE(same(more.row(1), fresh.row(0)));
}

TEST(ObserveTrials, AnotherInstrumentUsesTheSameSimulation) {
    const SmallTrials small;
    Device device;
    Trial biased = small.trial(1);
    biased.model.instrument.strain_offset = 1e-3;
    Watched one, two;
    observe_trials(device, small.common, {small.trial(1)}, small.store, one.options());
    const SmallTrials fresh;
    const auto rows =
        observe_trials(device, fresh.common, {fresh.trial(1), biased}, fresh.store, two.options());
    EXPECT_FALSE(same(rows.row(0), rows.row(1)));
    EXPECT_EQ(files_in(fresh.folder.path / "simulations"), 2);
    // The number of intervals is that of one simulation, for any number of instruments.
    EXPECT_EQ(two.calls, one.calls);
}

TEST(ObserveTrials, ContinueAfterAnInterruption) {
    const SmallTrials small;
    Device device;
    Callbacks impatient;
    impatient.stop_wanted = [] { return true; };
    EXPECT_THROW(observe_trials(device, small.common, {small.trial(1)}, small.store, impatient), Interrupted);
    EXPECT_EQ(files_in(small.folder.path / "simulations"), 0);
    const auto later = observe_trials(device, small.common, {small.trial(1)}, small.store, {});
    const SmallTrials fresh;
    EXPECT_TRUE(
        same(later.row(0), observe_trials(device, fresh.common, {fresh.trial(1)}, fresh.store, {}).row(0)));
}

TEST(ObserveTrials, StoreRecordings) {
    const SmallTrials small;
    Device device;
    observe_trials(device, small.common, {small.trial(1)}, small.store, {});
    EXPECT_ANY_THROW(kept_recordings(device, small.common, {small.trial(1)}, small.store));
    Trial kept = small.trial(1);
    kept.keep_recording = true;
    const auto row = observe_trials(device, small.common, {kept}, small.store, {});
    const auto recordings = kept_recordings(device, small.common, {kept}, small.store);
    ASSERT_EQ(recordings.size(), 1u);
    EXPECT_EQ(recordings[0].diameter.size(), small.packing.size());
    EXPECT_NE(recordings[0].diameter[0], small.packing.diameter[0]);  // as measured
    const Eigen::VectorXd seen = observe(recordings[0], small.common.grid, small.common.material);
    for (Eigen::Index bin = 0; bin < seen.size(); ++bin)
        if (std::isfinite(seen[bin])) {
            EXPECT_NEAR(seen[bin], row(0, bin), 1e-4) << bin;  // positions are stored as floats: 1e-8 m
        }
    EXPECT_EQ(seen.array().isFinite().count(), row.array().isFinite().count());
    Watched again;
    observe_trials(device, small.common, {kept}, small.store, again.options());
    EXPECT_EQ(again.calls, 0);
}

TEST(ObserveTrials, EndWhenNoBinNeedsMoreScans) {
    SmallTrials small;
    small.common.grid.width = 0.003;  // the scan at 3.3 mm during unloading is the first that no bin needs
    Device device;
    Trial kept = small.trial(1);
    kept.keep_recording = true;
    Watched ended, whole;
    const auto row = observe_trials(device, small.common, {small.trial(1)}, small.store, ended.options());
    const SmallTrials fresh;
    const auto row_of_whole = observe_trials(device, small.common, {kept}, fresh.store, whole.options());
    EXPECT_EQ(kept_recordings(device, small.common, {kept}, fresh.store)[0].scans.size(), 6u);
    EXPECT_LT(ended.calls, 0.95 * whole.calls);
    EXPECT_TRUE(same(row.row(0), row_of_whole.row(0)));
}

/// Tests whether a trial is given the stored observation of small.trial(1), the only one in the store.
class Names {
public:
    Names() { observe_trials(device_, small.common, {small.trial(1)}, small.store, {}); }

    bool taken_for_the_kept(const TrialSettings& common, const Trial& trial) {
        Callbacks impatient;
        impatient.stop_wanted = [] { return true; };
        try {
            observe_trials(device_, common, {trial}, small.store, impatient);
            return true;
        } catch (const Interrupted&) {
            return false;
        } catch (const std::exception&) {
            return false;  // not found, and it cannot be simulated
        }
    }
    bool taken_for_the_kept(const Trial& trial) { return taken_for_the_kept(small.common, trial); }

    SmallTrials small;

private:
    Device device_;
};

TEST(TrialNames, AreReproducible) {
    Names names;
    EXPECT_TRUE(names.taken_for_the_kept(names.small.trial(1)));
    Trial relabelled = names.small.trial(1);
    relabelled.model.replica.label = "another label";
    EXPECT_TRUE(names.taken_for_the_kept(relabelled));
}

TEST(TrialNames, DifferForSeedsJittersAndPackings) {
    Names names;
    const auto expect_apart = [&](const char* what, const std::function<void(Trial&)>& change) {
        Trial trial = names.small.trial(1);
        change(trial);
        EXPECT_FALSE(names.taken_for_the_kept(trial)) << what;
    };
    expect_apart("seed", [](Trial& t) { t.seed = 2; });
    expect_apart("jitter", [](Trial& t) { t.jitter = 2e-5; });
    expect_apart("diameter jitter", [](Trial& t) { t.diameter_jitter = 2e-5; });
    expect_apart("swapped jitters", [](Trial& t) { t.jitter = 0, t.diameter_jitter = 2e-5; });
    expect_apart("position", [](Trial& t) { t.packing.position[3].y() += 1e-12; });
    expect_apart("diameter", [](Trial& t) { t.packing.diameter[3] += 1e-12; });
}

TEST(TrialNames, DifferForLargeSeeds) {
    SmallTrials small;
    Device device;
    const std::uint64_t seed =
        std::numeric_limits<std::uint64_t>::max() - 1;  // as a double it equals the next number
    const auto rows =
        observe_trials(device, small.common, {small.trial(seed), small.trial(seed + 1)}, small.store, {});
    EXPECT_FALSE(same(rows.row(0), rows.row(1)));
    EXPECT_EQ(files_in(small.folder.path / "simulations"), 2);
}

/// Changes the value of a key slightly, to the next word, or to the other truth value.
void move(Settings& settings, const Key& key) {
    std::visit(
        [&](auto member) {
            auto& value = member(settings);
            using Value = std::remove_reference_t<decltype(value)>;
            if constexpr (std::is_same_v<Value, double>)
                value = value == 0 ? 1e-9 : value * (1 + 1e-12);
            else if constexpr (std::is_same_v<Value, std::string>)
                value += "?";
            else if constexpr (std::is_same_v<Value, bool>)
                value = !value;
            else if constexpr (std::is_enum_v<Value>)
                value = static_cast<Value>(static_cast<int>(value) == 0 ? 1 : 0);
            else if constexpr (std::is_same_v<Value, std::vector<double>>)
                value.push_back(1);
            else
                ++value;
        },
        key.member);
}

TEST(TrialNames, DifferForEveryKeyOfAReplica) {
    Names names;
    int tried = 0;
    for (const Key& key : keys()) {
        if (key.scope != Scope::replica || is_generator_key(key.name) || key.name == "packing.file" ||
            key.name == "packing.frame" || key.name == "container.radius" ||  // part of the sizes of the box
            key.name == "container.height")  // of a cell, which has no trials
            continue;
        Trial trial = names.small.trial(1);
        Settings settings;
        settings.replica = trial.model.replica;
        move(settings, key);
        trial.model.replica = settings.replica;
        EXPECT_FALSE(names.taken_for_the_kept(trial)) << key.name;
        ++tried;
    }
    EXPECT_GT(tried, 40);
}

// Checks the table of keys against the struct: a member without a key would be missing in names.
TEST(TrialNames, DifferForEveryEffect) {
    Names names;
    constexpr std::size_t count = sizeof(Effects) / sizeof(double);
    for (std::size_t k = 0; k < count; ++k) {
        Trial trial = names.small.trial(1);
        reinterpret_cast<double*>(&trial.model.replica.effects)[k] += 1e-9;
        EXPECT_FALSE(names.taken_for_the_kept(trial)) << k;
    }
}

/// Changes every double of a struct that contains only doubles, one after the other.
template <class Plain>
void for_each_number(Plain& plain, const std::function<void(std::size_t)>& look) {
    static_assert(std::is_trivially_copyable_v<Plain> && sizeof(Plain) % sizeof(double) == 0);
    for (std::size_t k = 0; k < sizeof(Plain) / sizeof(double); ++k) {
        const Plain before = plain;
        double& value = reinterpret_cast<double*>(&plain)[k];
        value = std::nextafter(value, 1e300);
        look(k);
        plain = before;
    }
}

TEST(TrialNames, DifferForInstruments) {
    Names names;
    Trial trial = names.small.trial(1);
    for_each_number(trial.model.instrument,
                    [&](std::size_t k) { EXPECT_FALSE(names.taken_for_the_kept(trial)) << k; });
}

TEST(TrialNames, DifferForSettings) {
    Names names;
    TrialSettings common = names.small.common;
    const auto expect_apart = [&](const char* what) {
        EXPECT_FALSE(names.taken_for_the_kept(common, names.small.trial(1))) << what;
        common = names.small.common;
    };
    EXPECT_TRUE(names.taken_for_the_kept(common, names.small.trial(1)));
    for_each_number(common.material, [&](std::size_t k) {
        EXPECT_FALSE(names.taken_for_the_kept(common, names.small.trial(1))) << k;
    });
    common.grid.width += 1e-9;
    expect_apart("width");
    common.grid.displacement[1] += 1e-9;
    expect_apart("displacement");
    common.discard = 1;
    expect_apart("discard");
    common.program = "another";
    expect_apart("program");
    common.scene.precision = Precision::double_precision;
    expect_apart("precision");
}

TEST(ObserveTrials, InPartsAreTheSame) {
    const SmallTrials small, alone;
    const std::vector<Trial> trials{small.trial(1), small.trial(2), small.trial(1)};
    Device device;
    const auto expected = observe_trials(device, alone.common, trials, alone.store, {});
    const std::size_t enough = 8'192 / trials.front().packing.size() + 2;  // one more than fits into a part
    std::vector<Trial> many;
    while (many.size() < enough) many.push_back(small.trial(many.size()));
    const auto parts = parts_of_trials(small.common, many);
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].size() + parts[1].size(), many.size());
    const auto few = parts_of_trials(small.common, trials);
    ASSERT_EQ(few.size(), 1u);
    EXPECT_FALSE(are_observed(device.description(), small.common, few[0], small.store));
    observe_trials(device, small.common, few[0], small.store, {});
    EXPECT_TRUE(are_observed(device.description(), small.common, trials, small.store));
    EXPECT_FALSE(are_observed("another", small.common, trials, small.store));
    EXPECT_EQ(files_in(small.folder.path / "simulations"), 2);
    Callbacks none;
    none.on_progress = [](double) { ADD_FAILURE() << "simulated again"; };
    const auto got = observe_trials(device, small.common, trials, small.store, none);
    for (Eigen::Index t = 0; t < expected.rows(); ++t) {
        EXPECT_TRUE(same(got.row(t), expected.row(t))) << t;
    }
}

}  // namespace
}  // namespace mcdem
