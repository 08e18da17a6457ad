// Serialised scans are read back unchanged; invalid bytes are refused.
#include "io/scan_bytes.h"

#include <gmock/gmock.h>

#include <cstring>

#include "core/errors.h"
#include "io/synthetic_run.h"

namespace mcdem {
namespace {

Run run_with_failure() {
    Run run = test::synthetic_run({2, 5, 3, "double"});
    run.recordings[1].failure = Failure{17, 2, "a cause"};
    return run;
}

Run without_scans(Run run) {
    for (Recording& recording : run.recordings) {
        recording.scans.clear();
        recording.failure.reset();
    }
    return run;
}

std::string problem(const std::vector<std::byte>& bytes) {
    Run run = without_scans(run_with_failure());
    try {
        add_scans(bytes, run.recordings, "here");
    } catch (const InputError& error) {
        return error.what();
    }
    return "none";
}

TEST(ScanBytes, AreReadBackUnchanged) {
    const mcdem::Run run = run_with_failure();
    const auto bytes = scan_bytes(run.recordings);
    mcdem::Run back = without_scans(run);
    add_scans(bytes, back.recordings, "here");
    EXPECT_EQ(scan_bytes(back.recordings), bytes);
    ASSERT_EQ(back.recordings[1].scans.size(), run.recordings[1].scans.size());
    EXPECT_EQ(back.recordings[1].scans[2].position, run.recordings[1].scans[2].position);
    EXPECT_EQ(back.recordings[1].scans[2].top_force(), run.recordings[1].scans[2].top_force());
    EXPECT_EQ(back.recordings[1].failure->cause, "a cause");
    EXPECT_EQ(back.recordings[1].failure->step, 17);
}

TEST(ScanBytes, OfWrongLengthAreRefused) {
    const auto bytes = scan_bytes(run_with_failure().recordings);
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_THAT(problem({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}),
                    testing::HasSubstr("here: "))
            << size;
    auto longer = bytes;
    longer.resize(bytes.size() + 8);
    EXPECT_THAT(problem(longer), testing::HasSubstr("more than this scene has replicas"));
}

TEST(ScanBytes, WithAnyWordChangedAreReadOrRefused) {
    const auto bytes = scan_bytes(run_with_failure().recordings);
    int refused = 0;
    for (std::size_t place = 0; place + 8 <= bytes.size(); place += 4)
        for (const std::uint64_t word : {std::uint64_t{0}, ~std::uint64_t{0}, std::uint64_t{1} << 61}) {
            auto changed = bytes;
            std::memcpy(&changed[place], &word, sizeof word);
            refused += problem(changed) != "none";
        }
    EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace mcdem
