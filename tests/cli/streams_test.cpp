// Standard output and error that cannot be written.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "cli/cli_test.h"
#include "cli/shell/progress.h"
#include "io/results.h"

namespace mcdem {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class StreamsTest : public CliTest {
protected:
    /// Runs bash in the folder; the program is $M.
    Finished shell(const std::string& script) const {
        return output_of_shell("cd " + folder_.path.string() + "; M=" MCDEM_BINARY "; " + script);
    }
    std::string result(const std::string& out) const { return bytes_of_file(path(out) / "run.h5"); }
};

const std::string run_into = "$M run small.toml --no-figures --out ";

TEST_F(StreamsTest, AFullOrClosedStandardErrorDoesNotEndARun) {
    expect_done(mcdem(run_words("whole")));
    EXPECT_EQ(shell(run_into + "full 2>/dev/full").exit_code, 0);
    EXPECT_EQ(shell(run_into + "closed 2>&- <&-").exit_code, 0);
    for (const char* out : {"full", "closed"}) EXPECT_TRUE(result(out) == result("whole")) << out;
}

TEST_F(StreamsTest, ResultsThatCannotBePrintedAreAFailureAndTheRunIsKept) {
    expect_done(mcdem(run_words("whole")));
    for (const std::string command :
         {"table whole", "--help", "run --help", "completion bash", "--version", "devices"}) {
        const auto end = shell("$M " + command + " 2>&1 >/dev/full");
        EXPECT_EQ(end.exit_code, 1) << command;
        EXPECT_THAT(end.out, HasSubstr("mcdem: standard output cannot be written")) << command;
    }
    EXPECT_THAT(shell("$M table whole 2>&1 >/dev/full").out, HasSubstr("No space left on device"));
    EXPECT_EQ(shell("$M table whole >&-").exit_code, 1);
    for (const std::string to : {"/dev/full", "&-"}) {
        EXPECT_EQ(shell("rm -rf out; " + run_into + "out >" + to).exit_code, 1) << to;
        EXPECT_TRUE(result("out") == result("whole")) << to;
    }
}

TEST_F(StreamsTest, APipeWithoutAReaderIsAFailureNotASignal) {
    const auto end = shell("exec 3> >(:); wait $!; $M --help 2>&1 >&3");
    EXPECT_EQ(end.signal, 0);
    EXPECT_EQ(end.exit_code, 1);
    EXPECT_THAT(end.out, HasSubstr("standard output cannot be written: Broken pipe"));
    expect_done(mcdem(run_words("whole")));
    EXPECT_EQ(shell("exec 3> >(:); wait $!; " + run_into + "out 2>&3").exit_code, 0);
    EXPECT_TRUE(result("out") == result("whole"));
}

TEST_F(StreamsTest, AFileSizeLimitIsAnErrorNotASignal) {
    expect_done(mcdem(run_words("whole")));
    const auto exported = shell("ulimit -c 0; ulimit -f 8; $M export whole --vtk --out view 2>&1");
    EXPECT_EQ(exported.signal, 0);
    EXPECT_EQ(exported.exit_code, 1) << exported.out;
    EXPECT_THAT(exported.out, HasSubstr("File too large"));
    const auto end = shell("ulimit -c 0; ulimit -f 8; " + run_into + "out 2>&1");
    EXPECT_EQ(end.signal, 0);
    EXPECT_EQ(end.exit_code, 1) << end.out;
    EXPECT_THAT(end.out, HasSubstr("the kernels do not compile"));
    EXPECT_FALSE(fs::exists(path("out/run.h5")));
    expect_done(mcdem(run_words("out", {"--resume"})));
    EXPECT_TRUE(result("out") == result("whole"));
}

TEST_F(StreamsTest, TooFewFileDescriptorsAreAnErrorAndASmallLimitIsRaised) {
    const auto end = shell("ulimit -c 0; ulimit -n 10; " + run_into + "out 2>&1");
    EXPECT_EQ(end.signal, 0);
    EXPECT_EQ(end.exit_code, 1) << end.out;
    EXPECT_THAT(end.out, HasSubstr("raise it (`ulimit -n`) to 64"));
    EXPECT_EQ(shell("ulimit -S -n 10; " + run_into + "out 2>&1").exit_code, 0);
}

/// Runs the program on a pseudo-terminal, with SIGHUP ignored.
class OnATerminal {
public:
    OnATerminal(const fs::path& folder, std::vector<std::string> words) {
        terminal_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
        EXPECT_TRUE(::grantpt(terminal_) == 0 && ::unlockpt(terminal_) == 0);
        const std::string name = ::ptsname(terminal_);
        words.insert(words.begin(), MCDEM_BINARY);
        std::vector<char*> arguments;
        for (auto& word : words) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        process_ = ::fork();
        if (process_ != 0) return;
        ::setsid();
        ::signal(SIGHUP, SIG_IGN);
        const int end = ::open(name.c_str(), O_RDWR);  // its controlling terminal
        for (int stream = 0; stream < 3; ++stream) ::dup2(end, stream);
        if (end > 2) ::close(end);
        if (::chdir(folder.c_str()) == 0) ::execv(MCDEM_BINARY, arguments.data());
        ::_exit(127);
    }
    ~OnATerminal() {
        if (process_ > 0) ::kill(process_, SIGKILL), ::waitpid(process_, nullptr, 0);
        if (terminal_ >= 0) ::close(terminal_);
    }
    /// Waits for the first output and blocks the run there; false if it had already ended.
    bool hold_after_first_words() {
        char words[1000];
        const auto size = ::read(terminal_, words, sizeof words);
        if (size < 1) return false;
        first_words_.assign(words, static_cast<std::size_t>(size));
        ::kill(process_, SIGSTOP);
        int status = 0;
        if (::waitpid(process_, &status, WUNTRACED) == process_ && WIFSTOPPED(status)) return true;
        process_ = -1;
        return false;
    }
    const std::string& first_words() const { return first_words_; }
    void take_away() { ::close(std::exchange(terminal_, -1)); }
    int resume() {
        int status = 0;
        ::kill(process_, SIGCONT);
        ::waitpid(std::exchange(process_, -1), &status, 0);
        return status;
    }

private:
    int terminal_ = -1;
    pid_t process_ = -1;
    std::string first_words_;
};

TEST_F(StreamsTest, AClosedTerminalDoesNotEndARun) {
    expect_done(mcdem(run_words("whole")));
    for (int attempt = 0;; ++attempt) {
        const auto out = "out" + std::to_string(attempt);
        OnATerminal run(folder_.path, run_words(out));
        if (!run.hold_after_first_words()) continue;  // it was faster than this test: try again
        run.take_away();
        const int status = run.resume();
        EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status << " " << run.first_words();
        EXPECT_TRUE(result(out) == result("whole"));
        break;
    }
}

TEST_F(StreamsTest, NamesFromFilesDoNotControlTheTerminal) {
    expect_done(mcdem(run_words("out")));
    mcdem::Run run = read_run(path("out"));
    for (Recording& recording : run.recordings)
        recording.label +=
            "\x1b]0;title\x07\xc2\x9b"
            "2J\r\x7f";
    write_run(path("other.h5"), run);
    const std::string make = "$M experiment from-run other.h5 --out e";
    for (const std::string& command : {make, make + " --replica 0", std::string("$M experiment check e"),
                                       std::string("$M table other.h5")}) {
        const std::string said = shell(command + " 2>&1").out;
        EXPECT_FALSE(said.empty()) << command;
        EXPECT_EQ(said.find_first_of("\x1b\x07\r\x7f"), said.npos) << command << "\n" << said;
        EXPECT_EQ(said.find("\xc2\x9b"), said.npos) << command << "\n" << said;
    }
}

TEST(ProgressStream, IgnoresAFullStream) {
    for (const auto style : {ProgressStyle::bar, ProgressStyle::lines}) {
        std::FILE* full = std::fopen("/dev/full", "w");
        ASSERT_TRUE(full);
        Progress::Clock::time_point now{};
        {
            Progress progress(full, style, [&] { return now; });
            for (int k = 0; k < 10; ++k, now += std::chrono::seconds(20))
                EXPECT_NO_THROW(progress.show(0.1 * k));
            EXPECT_TRUE(std::ferror(full));
        }
        std::fclose(full);
    }
}

}  // namespace
}  // namespace mcdem
