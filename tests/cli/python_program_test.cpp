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
    /// Runs this text, which makes the file `started`, and sends this process a signal then.
    int interrupted(const std::string& text, int signal) const {
        std::thread user([&] {
            while (!fs::exists(path("started"))) std::this_thread::sleep_for(std::chrono::milliseconds(1));
            fs::remove(path("started"));
            ::kill(::getpid(), signal);
        });
        const int exit_code = run(text, {folder_.path.string()});
        user.join();
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
    struct Case {
        const char* text;
        int exit_code;
        const char* said;  ///< regular expression
    };
    const char* const internal = "mcdem: internal error: [A-Za-z]+[^\n]*; please report it[^\n]*\n";
    for (const auto& [text, exit_code, said] : {
             Case{"from mcdem.errors import InputError\nraise InputError(['a: b', 'c: d'])", 2,
                  "mcdem: a: b\nmcdem: c: d\n"},
             {"from mcdem.errors import RunError\nraise RunError('no disk')", 1, "mcdem: no disk\n"},
             {"open('/no/such/file')", 1, "mcdem: /no/such/file: No such file or directory\n"},
             {"import no_such_package.inside", 1, "mcdem: .*install python3-no_such_package.*MCDEM_PYTHON\n"},
             {"import sys\nsys.exit('a reason')", 1, "mcdem: a reason\n"},
             {"class Left:\n    def __del__(self):\n        raise ValueError('lost')\nLeft()", 0, ""},
             {"raise ValueError('odd\\nthing')", 1, internal},
             {"raise KeyError(3)", 1, internal},
             {"raise RecursionError('odd thing')", 1, internal},
             {"raise AssertionError()", 1, internal},
             {"raise OSError()", 1, internal},
         }) {
        EXPECT_EQ(run(text), exit_code) << text;
        EXPECT_THAT(err_, testing::MatchesRegex(said)) << text;
    }
    set("MCDEM_DEBUG", "1");
    EXPECT_EQ(run("raise KeyError(3)\n"), 1);
    EXPECT_THAT(err_, HasSubstr("Traceback"));
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

TEST_F(PythonProgramTest, OpenBlasHasOneThreadUnlessTheUserSetsAnother) {
    const char* const print = "import os\nprint(os.environ['OPENBLAS_NUM_THREADS'])\n";
    set("OPENBLAS_NUM_THREADS", "3");
    EXPECT_EQ(run(print), 0);
    EXPECT_EQ(out_, "3\n");
    ::unsetenv("OPENBLAS_NUM_THREADS");
    EXPECT_EQ(run(print), 0);
    EXPECT_EQ(out_, "1\n");
}

TEST_F(PythonProgramTest, AModuleInTheCurrentFolderIsNotUsed) {
    const fs::path here = fs::current_path();
    fs::current_path(folder_.path);
    for (const char* name :
         {"json", "os", "runpy", "signal", "site", "encodings", "sitecustomize", "usercustomize", "argparse"})
        std::ofstream(path(name + std::string(".py"))) << "raise SystemExit('not Python\\'s own')\n";
    set("PYTHONINSPECT", "1");
    set("PYTHONHOME", folder_.path);
    set("PYTHONUSERBASE", ".");
    for (const char* folders : {"", ":/opt/x", "/opt/x:", ".", "./", "..:/opt/x::", "~"}) {
        set("PYTHONPATH", folders);
        testing::internal::CaptureStdout();
        const int exit_code = run_python_module("json.tool", {"--help"});
        EXPECT_THAT(testing::internal::GetCapturedStdout(), HasSubstr("usage: ")) << folders;
        EXPECT_EQ(exit_code, 0) << folders;
    }
    fs::current_path(here);
}

TEST_F(PythonProgramTest, AnInterpreterInTheCurrentFolderIsNotUsed) {
    const fs::path here = fs::current_path();
    std::ofstream(path("my_python")) << "#!/bin/sh\n";
    fs::permissions(path("my_python"), fs::perms::owner_all);
    fs::current_path(folder_.path);
    set("MCDEM_PYTHON", "my_python");
    for (const std::string relative : {".:/usr/bin", ":/usr/bin", "/usr/bin:"}) {
        set("PATH", relative);
        EXPECT_THROW(run_python_module("json.tool", {"--help"}), RunError) << relative;
    }
    set("PATH", "/usr/bin:" + folder_.path.string());
    EXPECT_EQ(run_python_module("json.tool", {"--help"}), 0);
    fs::current_path(here);
}

/// Packages installed for the user alone are there, as without isolation, unless others may write them.
TEST_F(PythonProgramTest, PackagesOfTheUserAreFoundIfTheyAreTheUsers) {
    EXPECT_EQ(run("import sys\nprint('%d.%d' % sys.version_info[:2])\n"), 0);
    const std::string version = out_.substr(0, out_.find('\n'));
    const fs::path packages = path("lib/python" + version + "/site-packages");
    fs::create_directories(packages);
    std::ofstream(packages / "of_the_user.py") << "print('found')\n";
    set("PYTHONUSERBASE", folder_.path);
    EXPECT_EQ(run("import of_the_user\n"), 0);
    EXPECT_EQ(out_, "found\n");
    fs::permissions(packages, fs::perms::all);
    EXPECT_EQ(run("import of_the_user\n"), 1);
}

TEST_F(PythonProgramTest, AnOldPythonIsRefused) {
    std::ofstream(path("fake.py"))
        << "import sys\nsys.version_info = (3, 10, 2)\nsys.version = '3.10.2 (main)'\n"
           "file = sys.argv.pop(1)\n"
           "exec(open(file).read(), {'__name__': '__main__', '__file__': file})\n";
    std::ofstream(path("old")) << "#!/bin/sh\nshift 3\nexec /usr/bin/python3 " << path("fake.py").string()
                               << " \"$@\"\n";
    fs::permissions(path("old"), fs::perms::owner_all);
    set("MCDEM_PYTHON", path("old"));
    EXPECT_EQ(run("print('has run')\n"), 1);
    EXPECT_EQ(out_, "");
    EXPECT_THAT(err_, AllOf(HasSubstr("is Python 3.10.2, but Python 3.11 or later is needed"),
                            HasSubstr("MCDEM_PYTHON")));
}

TEST_F(PythonProgramTest, ControlCharactersDoNotReachTheTerminal) {
    EXPECT_EQ(
        run("import sys\n"
            "from mcdem.errors import InputError\n"
            "name = 'a\\x1b]0;b\\x07\\r\\x7f\\x9b2J\\u202ec\\u2066\\u2028d\\udc9b\\u061c\\te\\u00e9\\udce9'\n"
            "print(name)\n"
            "sys.stdout.writelines([name])\n"
            "raise InputError(name)\n"),
        2);
    const std::string shown = "a ]0;b    2J c  d  \te\xc3\xa9\xe9";
    EXPECT_EQ(out_, shown + "\n" + shown);
    EXPECT_EQ(err_, "mcdem: " + shown + "\n");
}

TEST_F(PythonProgramTest, AnInterruptedCommandCleansUpFirst) {
    for (const int signal : {SIGINT, SIGTERM}) {
        EXPECT_EQ(interrupted("import pathlib, sys, time\n"
                              "from mcdem.files import new_file, temporary_folder\n"
                              "with new_file(sys.argv[1] + '/result'), temporary_folder() as folder:\n"
                              "    print(folder, flush=True)\n"
                              "    (folder / 'kept').touch()\n"
                              "    pathlib.Path(sys.argv[1], 'started').touch()\n"
                              "    time.sleep(600)\n",
                              signal),
                  130);
        EXPECT_EQ(err_, "");
        EXPECT_FALSE(fs::exists(out_.substr(0, out_.find('\n')))) << out_;
        for (const auto& entry : fs::directory_iterator(folder_.path))
            EXPECT_EQ(entry.path().filename().string().find("result"), std::string::npos) << entry.path();
    }
}

/// Also in the middle of an import, where an exception would become another one, at any moment of the start.
TEST_F(PythonProgramTest, AnInterruptedImportIsCalledInterrupted) {
    std::ofstream(path("slow.py")) << "import pathlib, sys, time\n"
                                      "pathlib.Path(sys.argv[1], 'started').touch()\n"
                                      "try:\n"
                                      "    time.sleep(600)\n"
                                      "except BaseException:\n"
                                      "    raise ImportError('half loaded') from None\n";
    EXPECT_EQ(interrupted("import slow\n", SIGINT), 130);
    EXPECT_EQ(err_, "");
}

}  // namespace
}  // namespace mcdem
