// Claims: one holder a task, none that is lost keeps it, and one that comes back does no harm.
#include "io/claims.h"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "io/process_identity.h"
#include "io/synthetic_run.h"

namespace mcdem::test {
namespace {

using namespace std::chrono_literals;

const std::vector<std::string> one{"a"};

TEST(claims, a_task_has_one_holder_and_is_free_when_that_one_goes) {
    TemporaryFolder place;
    Claims mine(place.path()), theirs(place.path());
    auto claim = mine.take_one_of({"a", "b"});
    ASSERT_TRUE(claim);
    EXPECT_EQ(claim->task(), "a");
    EXPECT_EQ(claim->holder(), 1);
    EXPECT_FALSE(theirs.take_one_of(one));
    EXPECT_EQ(theirs.take_one_of({"a", "b"})->task(), "b");
    claim.reset();
    const auto next = theirs.take_one_of(one);
    ASSERT_TRUE(next);
    EXPECT_EQ(next->holder(), 2);
}

TEST(claims, say_on_which_device_their_holder_works) {
    TemporaryFolder place;
    Claims claims(place.path(), {3, "some device"});
    const auto device = [&] {
        return nlohmann::json::parse(std::ifstream(place / "a.claim-000001"))["device"];
    };
    auto claim = claims.take_one_of(one);
    EXPECT_EQ(device(), nlohmann::json({{"number", 3}, {"name", "some device"}}));
    claim.reset();
    EXPECT_EQ(device()["number"], 3);
}

TEST(claims, tasks_that_were_held_least_often_come_first) {
    TemporaryFolder place;
    Claims claims(place.path());
    claims.take_one_of(one).reset();
    EXPECT_EQ(claims.take_one_of({"a", "b"})->task(), "b");
}

TEST(claims, many_threads_at_once_get_one_holder_of_each_task) {
    TemporaryFolder place;
    std::vector<std::string> tasks;
    for (int k = 0; k < 20; ++k) tasks.push_back(std::to_string(k));
    std::mutex mutex;
    std::vector<std::unique_ptr<Claim>> taken;
    std::vector<std::jthread> threads;
    for (int t = 0; t < 8; ++t)
        threads.emplace_back([&] {
            Claims claims(place.path());
            while (auto claim = claims.take_one_of(tasks)) {
                const std::lock_guard lock(mutex);
                taken.push_back(std::move(claim));
            }
        });
    threads.clear();
    std::vector<std::string> names;
    for (const auto& claim : taken) names.push_back(claim->task());
    EXPECT_THAT(names, testing::UnorderedElementsAreArray(tasks));
}

/// A process that takes a task and ends without a word.
void take_and_die(const std::filesystem::path& folder) {
    const pid_t process = ::fork();
    if (process == 0) {
        Claims claims(folder);
        auto* claim = claims.take_one_of(one).release();
        ::_exit(claim ? 0 : 1);
    }
    int status = 0;
    ::waitpid(process, &status, 0);
    ASSERT_EQ(status, 0);
}

TEST(claims, of_a_process_that_was_killed_they_are_free_at_once) {
    TemporaryFolder place;
    take_and_die(place.path());
    const auto claim = Claims(place.path()).take_one_of(one);
    ASSERT_TRUE(claim);
    EXPECT_EQ(claim->holder(), 2);
}

/// A claim of a process on another machine, at this beat.
void claim_elsewhere(const TemporaryFolder& place, int beat) {
    replace_file(place / "a.claim-000001", nlohmann::json{{"state", "held"},
                                                          {"machine", "another"},
                                                          {"process", 1},
                                                          {"started", 2},
                                                          {"beats", beat},
                                                          {"fraction", 0.25}}
                                               .dump());
}

TEST(claims, of_another_machine_are_kept_as_long_as_they_show_life) {
    TemporaryFolder place;
    constexpr Seconds lease{3};
    Claims claims(place.path(), {}, lease);
    auto last_change = std::chrono::steady_clock::now();
    for (int beat = 0; beat < 3; ++beat) {
        claim_elsewhere(place, beat);
        EXPECT_FALSE(claims.take_one_of(one)) << beat;
        last_change = std::chrono::steady_clock::now();
        std::this_thread::sleep_for(300ms);
        const bool is_taken = claims.take_one_of(one) != nullptr;
        ASSERT_TRUE(!is_taken || std::chrono::steady_clock::now() - last_change > lease) << beat << ", a little later";
        if (is_taken) GTEST_SKIP() << "this machine stood still for longer than the lease";
    }
    EXPECT_EQ(claims.under_way().at("a"), 0.25);
    while (!claims.take_one_of(one)) std::this_thread::sleep_for(50ms);
    EXPECT_GT(std::chrono::steady_clock::now() - last_change, lease - 100ms);
}

TEST(claims, that_are_damaged_are_waited_for_and_then_taken) {
    TemporaryFolder place;
    write_bytes(place / "a.claim-000001", "{");
    Claims claims(place.path(), {}, Seconds(0.1));
    EXPECT_FALSE(claims.take_one_of(one));
    std::this_thread::sleep_for(150ms);
    EXPECT_TRUE(claims.take_one_of(one));
}

TEST(claims, show_life_and_how_far_they_are) {
    TemporaryFolder place;
    Claims claims(place.path(), {}, Seconds(0.2));
    const auto claim = claims.take_one_of(one);
    claim->show(0.75);
    while (claims.under_way().at("a") != 0.75) std::this_thread::sleep_for(10ms);
}

TEST(process_identity, tells_the_living_from_the_dead) {
    EXPECT_EQ(life_of(this_process()), Life::alive);
    ProcessIdentity before_me = this_process();
    before_me.started -= 1;  // the number was another's
    EXPECT_EQ(life_of(before_me), Life::ended);
    ProcessIdentity elsewhere = this_process();
    elsewhere.machine += "2";
    EXPECT_EQ(life_of(elsewhere), Life::cannot_be_told);
}

TEST(create_file, one_of_many_is_first_and_its_text_stays) {
    TemporaryFolder place;
    std::atomic<int> first{0}, winner{-1};
    {
        std::vector<std::jthread> threads;
        for (int t = 0; t < 8; ++t)
            threads.emplace_back([&, t] {
                if (!create_file(place / "file", std::to_string(t))) return;
                ++first;
                winner = t;
            });
    }
    EXPECT_EQ(first, 1);
    EXPECT_EQ(read_bytes(place / "file"), std::to_string(winner));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(place.path()), {}), 1) << "temporaries stay";
}

}  // namespace
}  // namespace mcdem::test
