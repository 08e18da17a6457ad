// The cache folder of compiled kernels: read-only, of another user, or with damaged files.
#include <sys/stat.h>

#include <csignal>

#include "cli/cli_test.h"

namespace mcdem {
namespace {

namespace fs = std::filesystem;

class KernelCache : public CliTest {
protected:
    std::vector<std::string> nowhere_to_write() const {
        return {"HOME=/proc", "XDG_CACHE_HOME=", "POCL_CACHE_DIR=/proc/none",
                "TMPDIR=" + path("tmp").string()};
    }
    fs::path private_folder() const { return path("tmp") / ("mcdem-kernels-" + std::to_string(geteuid())); }
    static mode_t mode_of(const fs::path& folder) {
        struct stat what {};
        lstat(folder.c_str(), &what);
        return what.st_mode & 07777;
    }
};

TEST_F(KernelCache, ReadOnlyFolderIsReplacedByAPrivateOne) {
    fs::create_directory(path("tmp"));
    expect_done(mcdem({"devices"}, nowhere_to_write()));
    EXPECT_EQ(mode_of(private_folder()), 0700u);
    expect_done(mcdem({"devices"}, nowhere_to_write()));
    EXPECT_EQ(std::distance(fs::directory_iterator(path("tmp")), {}), 1) << "the same again";
}

TEST_F(KernelCache, FolderOfAnotherUserIsNotUsed) {
    fs::create_directory(path("tmp"));
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

TEST_F(KernelCache, FailsIfNoFolderIsWritable) {
    auto environment = nowhere_to_write();
    environment.back() = "TMPDIR=/proc";
    const auto devices = mcdem({"devices"}, environment);
    EXPECT_EQ(devices.exit_code, 1);
    EXPECT_THAT(devices.err, testing::HasSubstr("set POCL_CACHE_DIR to a folder"));
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
