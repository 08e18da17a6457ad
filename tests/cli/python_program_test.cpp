// Commands written in Python: arguments, interruption, and the message if a part is missing.
#include "cli/shell/python_program.h"

#include <unistd.h>

#include <csignal>

#include "cli/cli_test.h"
#include "core/errors.h"

namespace mcdem {
namespace {

using testing::AllOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

class PythonProgramTest : public testing::Test {
protected:
    PythonProgramTest() { set("PYTHONPATH", folder_.path.string()); }
    ~PythonProgramTest() override {
        for (const auto& [name, value] : before_)
            value ? ::setenv(name.c_str(), value->c_str(), 1) : ::unsetenv(name.c_str());
    }
    void set(const std::string& name, const std::string& value) {
        const char* before = std::getenv(name.c_str());
        before_.emplace(name, before ? std::optional<std::string>(before) : std::nullopt);
        ::setenv(name.c_str(), value.c_str(), 1);
    }
    fs::path path(const std::string& name) const { return folder_.path / name; }
    /// Runs this text as a module.
    int run(const std::string& text, const std::vector<std::string>& arguments = {}) const {
        std::ofstream(path("tried.py")) << text;
        testing::internal::CaptureStdout();
        testing::internal::CaptureStderr();
        const int exit_code = run_python_module("tried", arguments);
        out_ = testing::internal::GetCapturedStdout();
        err_ = testing::internal::GetCapturedStderr();
        return exit_code;
    }

    TestFolder folder_;
    std::map<std::string, std::optional<std::string>> before_;
    mutable std::string out_, err_;
};

TEST_F(PythonProgramTest, ArgumentsOutputAndExitCodeArePassed) {
    EXPECT_EQ(run("import sys\nprint(sys.argv[1:])\nsys.exit(7)\n", {"a b", "", "--out", "\xc3\xa9"}), 7);
    EXPECT_EQ(out_, "['a b', '', '--out', '\xc3\xa9']\n");
    EXPECT_EQ(run("print(__name__)\n"), 0);
    EXPECT_EQ(out_, "__main__\n");
}

TEST_F(PythonProgramTest, ErrorsHaveTheExitCodesAndFormatOfTheProgram) {
    EXPECT_EQ(run("from mcdem.errors import InputError\nraise InputError(['a: b', 'c: d'])\n"), 2);
    EXPECT_EQ(err_, "mcdem: a: b\nmcdem: c: d\n");
    EXPECT_EQ(run("from mcdem.errors import RunError\nraise RunError('no disk')\n"), 1);
    EXPECT_EQ(err_, "mcdem: no disk\n");
    EXPECT_EQ(run("open('/no/such/file')\n"), 1);
    EXPECT_EQ(err_, "mcdem: /no/such/file: No such file or directory\n");
    EXPECT_EQ(run("import no_such_package.inside\n"), 1);
    EXPECT_THAT(err_, AllOf(HasSubstr("install python3-no_such_package"), HasSubstr("MCDEM_PYTHON")));
}

TEST_F(PythonProgramTest, MissingPartsAreNamed) {
    set("MCDEM_PYTHON", path("no_python").string());
    EXPECT_THAT(
        [&] { run_python_module("tried", {}); },
        testing::ThrowsMessage<RunError>(AllOf(HasSubstr("no_python"), HasSubstr("install python3"))));
    set("MCDEM_PYTHON_FOLDER", path("nowhere").string());
    EXPECT_THAT([&] { run_python_module("tried", {}); },
                testing::ThrowsMessage<RunError>(HasSubstr("nowhere")));
}

TEST_F(PythonProgramTest, AModuleInTheCurrentFolderIsNotUsed) {
    const fs::path here = fs::current_path();
    std::ofstream(path("json.py")) << "raise SystemExit('not Python\\'s own')\n";
    set("PYTHONPATH", "");
    fs::current_path(folder_.path);
    testing::internal::CaptureStdout();
    const int exit_code = run_python_module("json.tool", {"--help"});
    fs::current_path(here);
    EXPECT_THAT(testing::internal::GetCapturedStdout(), HasSubstr("usage: "));
    EXPECT_EQ(exit_code, 0);
}

TEST_F(PythonProgramTest, AnInterruptedCommandCleansUpFirst) {
    for (const int signal : {SIGINT, SIGTERM}) {
        std::thread user([&] {
            while (!fs::exists(path("started"))) std::this_thread::sleep_for(std::chrono::milliseconds(1));
            fs::remove(path("started"));
            ::kill(::getpid(), signal);
        });
        EXPECT_EQ(run("import pathlib, sys, time\n"
                      "try:\n"
                      "    pathlib.Path(sys.argv[1], 'started').touch()\n"
                      "    while True:\n"
                      "        time.sleep(1)\n"
                      "finally:\n"
                      "    pathlib.Path(sys.argv[1], f'order{sys.argv[2]}').touch()\n",
                      {folder_.path.string(), std::to_string(signal)}),
                  130);
        user.join();
        EXPECT_EQ(err_, "");
        EXPECT_TRUE(fs::exists(path("order" + std::to_string(signal))));
    }
}

}  // namespace
}  // namespace mcdem
