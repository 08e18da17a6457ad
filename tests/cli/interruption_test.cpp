// Killed, interrupted, with damaged files or a full disk: a resumed run ends with the same bits as an
// uninterrupted one.
#include <sys/mount.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <memory>
#include <random>
#include <thread>

#include "cli/cli_test.h"

namespace mcdem {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;
using namespace std::chrono_literals;

/// Checkpoints as often as the disk allows.
const std::vector<std::string> often{"--set", "output.checkpoint_minutes=1e-6"};

/// of about 4,500 launches in a run of the small scene
constexpr int some_launches = 1500;

class InterruptionTest : public CliTest {
protected:
    static std::vector<std::string> words(const std::string& out, bool resume) {
        auto all = run_words(out, often);
        if (resume) all.push_back("--resume");
        return all;
    }
    /// A run that is blocked after it has written some, but not all, of its checkpoints.
    std::unique_ptr<Child> held(const std::string& out) const {
        auto child = std::make_unique<Child>(folder_.path, words(out, false), held_after(some_launches));
        wait_until_held(*child);
        return child;
    }
    std::string result(const std::string& out) const { return bytes_of_file(path(out) / "run.h5"); }

    /// The resumed run ends with the bits of the uninterrupted run.
    void expect_goes_on(const std::string& out) const {
        expect_done(mcdem(words(out, true)));
        EXPECT_TRUE(result(out) == result("whole"));
    }

    /// Starts a run and stops it by `signal` in the middle.
    Finished interrupt(const std::string& out, int signal) const {
        const auto child = held(out);
        child->send(signal);
        let_go_on(*child);
        return child->wait();
    }
};

TEST_F(InterruptionTest, KilledAtAnyTimeAndResumedGivesTheSameBits) {
    expect_done(mcdem(words("whole", false)));
    std::mt19937 random(1);
    std::uniform_int_distribution<int> launches(1, some_launches), microseconds(0, 5000);
    const int max_kills = 100,
              kills_while_held =
                  3;  // within half of the launches, so that the number does not depend on the speed
    int kills = 0;
    for (bool resume = false;; resume = true) {
        const bool stays_held = kills < kills_while_held;
        Child child(folder_.path, words("killed", resume),
                    held_after(launches(random) / (stays_held ? 2 : 1)));
        while (child.is_running() && !fs::exists(held_file(child))) std::this_thread::sleep_for(100us);
        if (!stays_held) {
            let_go_on(child);
            std::this_thread::sleep_for(std::chrono::microseconds(microseconds(random)));
        }
        if (kills < max_kills) child.send(SIGKILL);
        const auto finished = child.wait();
        if (finished.signal != SIGKILL) {
            expect_done(finished);
            break;
        }
        ++kills;
    }
    EXPECT_GT(kills, 2);
    EXPECT_LT(kills, max_kills) << "resumed runs do not get on";
    EXPECT_FALSE(result("whole").empty());
    EXPECT_TRUE(result("killed") == result("whole"));
    EXPECT_EQ(bytes_of_file(path("killed/plate.csv")), bytes_of_file(path("whole/plate.csv")));
}

TEST_F(InterruptionTest, KilledBeforeItsFirstCheckpointStartsAgain) {
    expect_done(mcdem(words("whole", false)));
    Child child(folder_.path, words("killed", false), held_after(0));
    wait_until_held(child);
    child.send(SIGKILL);
    ASSERT_EQ(child.wait().signal, SIGKILL);
    expect_goes_on("killed");
}

TEST_F(InterruptionTest, InterruptedSaysHowToResume) {
    expect_done(mcdem(words("whole", false)));
    for (int signal : {SIGINT, SIGTERM}) {
        const auto out = "stopped by " + std::to_string(signal);
        const auto stopped = interrupt(out, signal);
        EXPECT_EQ(stopped.exit_code, 130) << stopped.err;
        EXPECT_THAT(stopped.err,
                    HasSubstr("mcdem run small.toml --set output.checkpoint_minutes=1e-6 --out '" + out +
                              "' --no-figures --resume"));
        expect_done(mcdem({"table", out}));  // existing scans can be read
        expect_done(mcdem(words(out, true)));
        EXPECT_TRUE(result(out) == result("whole"));
    }
}

/// Shortened scenes with programmes, by name: holds and forces of a plate, strains of a cell.
class ProgrammeInterruptionTest : public InterruptionTest, public testing::WithParamInterface<const char*> {
protected:
    std::vector<std::string> programme(const std::string& out, bool resume) const {
        auto words =
            split(fmt::format("run {}/scenes/{}.toml --no-figures --set protocol.relax_time=0.01 --out {} ",
                              MCDEM_SOURCE_DIR, GetParam(), out) +
                  (std::string(GetParam()) == "cell"
                       ? "--set programme.1.strain=0.02 --set programme.2.shear_xz=0.05"
                       : "--set programme.1.strain=0.05 --set programme.2.time=0.02 --set "
                         "programme.2.scan_at=[0.01,0.02] --set programme.3.force=0.3 --set "
                         "programme.4.time=0.02"));
        words.insert(words.end(), often.begin(), often.end());
        if (resume) words.push_back("--resume");
        return words;
    }
};

TEST_P(ProgrammeInterruptionTest, KilledAndResumedGivesTheSameBits) {
    expect_done(mcdem(programme("whole", false)));
    int kills = 0;
    for (const int launches : {200, 400, 600, 800}) {
        Child child(folder_.path, programme("killed", kills > 0), held_after(launches));
        while (child.is_running() && !fs::exists(held_file(child))) std::this_thread::sleep_for(100us);
        if (!child.is_running()) break;
        child.send(SIGKILL);
        EXPECT_EQ(child.wait().signal, SIGKILL);
        ++kills;
    }
    EXPECT_GT(kills, 1);
    expect_done(mcdem(programme("killed", true)));
    EXPECT_TRUE(result("killed") == result("whole"));
    EXPECT_EQ(bytes_of_file(path("killed/plate.csv")), bytes_of_file(path("whole/plate.csv")));
}

INSTANTIATE_TEST_SUITE_P(Scenes, ProgrammeInterruptionTest, testing::Values("hold", "cell"),
                         [](const auto& about) { return std::string(about.param); });

TEST_F(InterruptionTest, OneThreadOrTwoGiveTheSameBits) {
    const std::string cell = "run " MCDEM_SOURCE_DIR
                             "/scenes/cell.toml --no-figures"
                             " --set protocol.relax_time=0.01 --set programme.1.strain=0.02";
    for (const std::string& scene : {std::string("run small.toml --no-figures"), cell}) {
        for (const std::string threads : {"1", "2"})
            expect_done(mcdem(split(scene + " --out " + threads), {"POCL_MAX_PTHREAD_COUNT=" + threads}));
        EXPECT_TRUE(result("1") == result("2")) << scene;
        for (const char* out : {"1", "2"}) fs::remove_all(path(out));
    }
}

TEST_F(InterruptionTest, ACellUnderStressGivesTheSameBitsKilledWithThreadsOrInParts) {
    const auto stressed = [&](const std::string& out, const std::vector<std::string>& more = {}) {
        std::vector<std::string> words{"run", "stressed.toml", "--out", out, "--no-figures"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    std::ofstream(path("stressed.toml")) << R"([container]
shape = "cell"
size_x = 0.07
size_y = 0.07
[packing]
count = 42
packing_fraction = 0.64
[grains]
friction = 0.3
[contact]
friction_law = "mindlin"
[protocol]
relax_time = 0.01
[[programme]]
pressure = 200
rate = 1
[[programme]]
stress_x = 200
stress_yz = -5
shear_xz = 0.01
scan_at = [0.004]
rate = 1
[[programme]]
stage = "hold"
keep = "stress"
time = 0.02
[output]
checkpoint_minutes = 1e-6
[batch]
replicas = 2
)";
    expect_done(mcdem(stressed("whole"), {"POCL_MAX_PTHREAD_COUNT=1"}));
    for (const int launches : {1000, 3000}) {
        const std::string out = "killed" + std::to_string(launches);
        Child child(folder_.path, stressed(out), held_after(launches));
        wait_until_held(child);
        child.send(SIGKILL);
        ASSERT_EQ(child.wait().signal, SIGKILL);
        expect_done(mcdem(stressed(out, {"--resume"}), {"POCL_MAX_PTHREAD_COUNT=2"}));
        EXPECT_TRUE(result(out) == result("whole")) << launches;
    }
    expect_done(mcdem(stressed("parts", {"--part-replicas", "1"})));
    EXPECT_TRUE(result("parts") == result("whole"));
}

TEST_F(InterruptionTest, UnsuitableFoldersAreRefused) {
    interrupt("a", SIGINT);
    const auto problem = [&](const std::vector<std::string>& arguments, const char* part) {
        const auto finished = mcdem(arguments);
        EXPECT_EQ(finished.exit_code, 2) << finished.err;
        EXPECT_THAT(finished.err, HasSubstr(part));
    };
    problem(words("a", false), "already holds a run");
    problem(run_words("a", {"--resume"}), "must be resumed with the scene it was begun with");
    problem(words("nowhere", true), "nothing to resume");
    problem(words("small.toml", false), "is a file");
    const auto unwritable = mcdem(words("/proc/nowhere", false));
    EXPECT_EQ(unwritable.exit_code, 1);
    EXPECT_THAT(unwritable.err, HasSubstr("mcdem: /proc/nowhere: cannot be made"));
}

TEST_F(InterruptionTest, TwoProcessesDoNotWriteToOneFolder) {
    const auto child = held("a");
    const fs::path elsewhere = path("elsewhere");
    fs::create_directory(elsewhere);
    auto second = words(path("a").string(), true);
    second[1] = path("small.toml").string();
    const auto refused = run_program(elsewhere, second);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.err, HasSubstr("another program is writing"));
    let_go_on(*child);
    expect_done(child->wait());
}

/// A disk of 32 MB, for users who may mount one.
class SmallDisk {
public:
    explicit SmallDisk(const fs::path& folder) : folder_(folder) {
        fs::create_directory(folder);
        mounted_ = ::mount("mcdem-test", folder.c_str(), "tmpfs", 0, "size=32m") == 0;
    }
    ~SmallDisk() {
        if (mounted_) ::umount2(folder_.c_str(), MNT_DETACH);
    }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;
    bool is_there() const { return mounted_; }
    void fill() const {
        std::ofstream out(folder_ / "filler", std::ios::binary);
        const std::string block(1 << 16, 'x');
        while (out.write(block.data(), static_cast<std::streamsize>(block.size()))) {
        }
    }
    void empty() const { fs::remove(folder_ / "filler"); }
    /// Also affects files that are open for writing: their contents stay, new writes fail.
    /// Waits for a thread that is still writing there.
    bool make_read_only() const {
        for (int tries = 0; ::mount("", folder_.c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr) != 0;
             ++tries) {
            if (errno != EBUSY || tries == 300) return false;
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        }
        return true;
    }
    bool make_writable() const { return ::mount("", folder_.c_str(), nullptr, MS_REMOUNT, nullptr) == 0; }

private:
    fs::path folder_;
    bool mounted_ = false;
};

/// The disk is full or read-only before the run starts or while it runs; it loses no recorded scan.
TEST_F(InterruptionTest, ADiskThatFailsEndsTheRunWhichCanBeResumedLater) {
    const SmallDisk disk(path("disk"));
    if (!disk.is_there()) GTEST_SKIP() << "needs the right to mount a small disk";
    expect_done(mcdem(words("whole", false)));
    disk.fill();
    const auto full = mcdem(words("disk/a", false));
    EXPECT_EQ(full.exit_code, 1) << full.err;
    EXPECT_THAT(full.err, HasSubstr("No space left"));
    EXPECT_FALSE(fs::exists(path("disk/a/run.h5")));
    disk.empty();
    expect_goes_on("disk/a");
    for (const bool is_full : {true, false}) {
        const std::string out = is_full ? "disk/b" : "disk/c";
        const auto child = held(out);
        if (is_full)
            disk.fill();
        else
            ASSERT_TRUE(disk.make_read_only());
        let_go_on(*child);
        const auto stopped = child->wait();
        EXPECT_EQ(stopped.exit_code, 1) << stopped.err;
        EXPECT_THAT(stopped.err, HasSubstr(is_full ? "No space left" : out));
        const auto table = line("table " + out);
        expect_done(table);
        EXPECT_THAT(table.out, HasSubstr("load"));
        if (is_full)
            disk.empty();
        else
            ASSERT_TRUE(disk.make_writable());
        expect_goes_on(out);
    }
}

TEST_F(InterruptionTest, FolderThatCannotBeWrittenToIsRefusedAtOnce) {
    const SmallDisk disk(path("disk"));
    if (!disk.is_there()) GTEST_SKIP() << "needs the right to mount a small disk";
    for (const char* folder : {"disk/empty", "disk/shared"}) fs::create_directory(path(folder));
    interrupt("disk/begun", SIGINT);
    ASSERT_TRUE(disk.make_read_only());
    const auto expect_refused = [&](const std::vector<std::string>& arguments, const char* problem) {
        const auto refused = mcdem(arguments);
        EXPECT_EQ(refused.exit_code, 1) << refused.err;
        EXPECT_THAT(refused.err, HasSubstr("mcdem: " + arguments[3]));
        EXPECT_THAT(refused.err,
                    HasSubstr(problem));  // from a check before the run, not from a failed write
    };
    expect_refused(words("disk/empty", false), "cannot be written to: Read-only file system");
    expect_refused(words("disk/begun", true), "cannot be written to: Read-only file system");
    expect_refused(run_words("disk/shared", {"--part=1/2"}), "cannot be written to: Read-only file system");
}

TEST_F(InterruptionTest, TruncatedFilesAreFoundBeforeResuming) {
    for (const std::string name : {"checkpoint.h5", "segment-000000.h5"}) {
        interrupt(name, SIGINT);
        const fs::path file = path(name) / name;
        fs::resize_file(file, fs::file_size(file) / 2);
        const auto refused = mcdem(words(name, true));
        EXPECT_EQ(refused.exit_code, 2) << refused.err;
        EXPECT_THAT(refused.err, HasSubstr(name + ": "));
        EXPECT_THAT(refused.err, HasSubstr(" again in another folder"));
        EXPECT_THAT(refused.err, testing::Not(HasSubstr("% done")));
    }
}

}  // namespace
}  // namespace mcdem
