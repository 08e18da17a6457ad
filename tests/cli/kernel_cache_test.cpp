// The cache folder of compiled kernels: read-only, of another user, or with damaged files.
#include <sys/stat.h>

#include <csignal>

#include "cli/cli_test.h"

namespace mcdem {
namespace {

namespace fs = std::filesystem;

class KernelCache : public CliTest {
protected:
    KernelCache() { fs::create_directory(path("tmp")); }
    std::string temporary() const { return "TMPDIR=" + path("tmp").string(); }
    std::vector<std::string> nowhere_to_write() const {
        return {"HOME=/proc", "XDG_CACHE_HOME=", "POCL_CACHE_DIR=/proc/none", temporary()};
    }
    fs::path private_folder() const { return path("tmp") / ("mcdem-kernels-" + std::to_string(geteuid())); }
    /// Compiled kernels below the folder.
    static std::vector<fs::path> kernels_in(const fs::path& folder) {
        std::vector<fs::path> files;
        for (const auto& entry : fs::recursive_directory_iterator(folder))
            if (entry.path().extension() == ".so") files.push_back(entry.path());
        return files;
    }
    static mode_t mode_of(const fs::path& folder) {
        struct stat what {};
        lstat(folder.c_str(), &what);
        return what.st_mode & 07777;
    }
};

TEST_F(KernelCache, ReadOnlyFolderIsReplacedByAPrivateOne) {
    expect_done(mcdem({"devices"}, nowhere_to_write()));
    EXPECT_EQ(mode_of(private_folder()), 0700u);
    expect_done(mcdem({"devices"}, nowhere_to_write()));
    EXPECT_EQ(std::distance(fs::directory_iterator(path("tmp")), {}), 1) << "the same again";
    auto environment = nowhere_to_write();
    environment.back() = "TMPDIR=/proc";
    const auto devices = mcdem({"devices"}, environment);
    EXPECT_EQ(devices.exit_code, 1);
    EXPECT_THAT(devices.err, testing::HasSubstr("set POCL_CACHE_DIR to a folder"));
}

TEST_F(KernelCache, FolderOfAnotherUserIsNotUsed) {
    fs::create_directory(path("theirs"));
    fs::create_directory_symlink(path("theirs"), private_folder());
    expect_done(mcdem({"devices"}, nowhere_to_write()));
    EXPECT_TRUE(fs::is_empty(path("theirs")));
    fs::remove(private_folder());
    fs::create_directory(private_folder());
    fs::permissions(private_folder(), fs::perms::all);
    expect_done(mcdem({"devices"}, nowhere_to_write()));
    EXPECT_TRUE(fs::is_empty(private_folder()));
}

TEST_F(KernelCache, WithoutAHomeKernelsAreKeptInAPrivateFolder) {
    for (const char* home : {"HOME=", "HOME=/nonexistent", "HOME=/proc", "HOME=relative"}) {
        expect_done(mcdem({"devices"}, {home, "XDG_CACHE_HOME=", "POCL_CACHE_DIR=", temporary()}));
        EXPECT_EQ(mode_of(private_folder()), 0700u) << home;
        EXPECT_FALSE(fs::exists("/nonexistent"));
        EXPECT_FALSE(fs::exists(path("relative"))) << home;
        fs::remove_all(private_folder());
    }
}

TEST_F(KernelCache, FolderWhereOthersCanWriteIsRefused) {
    const std::string base = path("base").string();
    const std::vector<std::vector<std::string>> environments{
        {"POCL_CACHE_DIR=" + base},
        {"POCL_CACHE_DIR=" + base + "/below"},
        {"POCL_CACHE_DIR=base"},
        {"POCL_CACHE_DIR=", "XDG_CACHE_HOME=" + base},
        {"POCL_CACHE_DIR=", "XDG_CACHE_HOME=", "HOME=" + base}};
    for (auto environment : environments) {
        environment.push_back(temporary());
        for (const auto open : {fs::perms::group_write, fs::perms::others_write}) {
            fs::create_directory(base);
            fs::permissions(base, fs::perms::owner_all | open);
            const auto devices = mcdem({"devices"}, environment);
            expect_done(devices);
            EXPECT_THAT(devices.err, testing::HasSubstr(base + ": others can write there (mode 07"))
                << environment[0];
            EXPECT_TRUE(fs::exists(private_folder()));
            fs::remove_all(private_folder());
            fs::remove_all(base);
        }
    }
    fs::create_directory(base);
    expect_done(mcdem({"devices"}, {"POCL_CACHE_DIR=base", temporary()}));
    EXPECT_FALSE(fs::exists(private_folder())) << "base is ours alone";
}

// They may have come when others could still write there.
TEST_F(KernelCache, KernelsOfOthersAreNotLoaded) {
    const std::vector<std::string> environment{"POCL_CACHE_DIR=" + path("cache").string(), temporary()};
    expect_done(mcdem(run_words("first"), environment));
    const auto kernels = kernels_in(path("cache"));
    ASSERT_FALSE(kernels.empty());
    const auto expect_refused = [&](const std::string& run) {
        const auto done = mcdem(run_words(run), environment);
        expect_done(done);
        EXPECT_THAT(done.err, testing::HasSubstr(": may hold compiled kernels of others: remove it"));
        EXPECT_FALSE(kernels_in(private_folder()).empty());
    };
    if (geteuid() == 0) {
        ASSERT_EQ(lchown(kernels.front().c_str(), 65534, 65534), 0);
        expect_refused("owned");
        ASSERT_EQ(lchown(kernels.front().c_str(), 0, 0), 0);
    }
    const auto done = mcdem(run_words("again"), environment);
    expect_done(done);
    EXPECT_THAT(done.err, testing::Not(testing::HasSubstr("of others")));
    fs::rename(kernels.front(), path("moved.so"));
    fs::create_symlink(path("moved.so"), kernels.front());
    expect_refused("linked");
}

TEST_F(KernelCache, DamagedFilesAreNamed) {
    const std::string cache = "POCL_CACHE_DIR=" + path("cache").string();
    expect_done(mcdem(run_words("first"), {cache}));
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(path("cache")))
        if (entry.path().filename() == "program.bc") files.push_back(entry.path());
    ASSERT_FALSE(files.empty());
    for (const fs::path& file : files) fs::resize_file(file, 0);
    const auto again = mcdem(run_words("again"), {cache});
    EXPECT_NE(again.exit_code, 0);
    EXPECT_THAT(again.err, testing::HasSubstr("compiled kernels are damaged"));
}

TEST_F(KernelCache, OldEmptyTemporaryFilesAreRemoved) {
    fs::create_directory(path("cache"));
    const auto old = fs::file_time_type::clock::now() - std::chrono::hours(25);
    for (const char* name : {"tempfile_old", "tempfile_new", "tempfile_full", "notes"}) {
        std::ofstream file(path("cache") / name);
        if (std::string_view(name) == "tempfile_full") file << "content";
        file.close();
        if (std::string_view(name) != "tempfile_new") fs::last_write_time(path("cache") / name, old);
    }
    expect_done(mcdem({"devices"}, {"POCL_CACHE_DIR=" + path("cache").string()}));
    EXPECT_FALSE(fs::exists(path("cache/tempfile_old")));
    for (const char* name : {"tempfile_new", "tempfile_full", "notes"})
        EXPECT_TRUE(fs::exists(path("cache") / name)) << name;
}

// As under nohup when the terminal closes. Signals arrive without a pause until the kernels are launched.
TEST_F(KernelCache, IgnoredSignalsDoNotDisturbTheCompiler) {
    expect_done(mcdem(run_words("whole")));
    const auto before = std::signal(SIGHUP, SIG_IGN);
    Child child(folder_.path, run_words("out"), held_after(0));
    std::signal(SIGHUP, before);
    while (child.is_running() && !fs::exists(held_file(child))) child.send(SIGHUP);
    if (child.is_running()) let_go_on(child);
    expect_done(child.wait());
    EXPECT_TRUE(bytes_of_file(path("out/run.h5")) == bytes_of_file(path("whole/run.h5")));
}

TEST_F(KernelCache, ACrashNamesTheRemedy) {
    Child child(folder_.path, run_words("out"), held_after(0));
    wait_until_held(child);
    child.send(SIGABRT);
    const auto finished = child.wait();
    EXPECT_EQ(finished.signal, SIGABRT);
    EXPECT_THAT(finished.err, testing::HasSubstr("remove the compiled kernels"));
}

}  // namespace
}  // namespace mcdem
