// The program as a child process: start, interruption, kill, output.
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace mcdem {

struct Finished {
    int exit_code = -1;  ///< -1 if a signal ended it
    int signal = 0;
    std::string out, err;
};

class Child {
public:
    /// Starts the program with these arguments in `folder`; `environment` ("NAME=value") is added.
    Child(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
          const std::vector<std::string>& environment = {});
    ~Child();
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    pid_t process() const { return pid_; }
    bool is_running();
    void send(int signal);
    Finished wait();

private:
    std::filesystem::path folder_;
    pid_t pid_ = -1;
    bool waited_ = false;
    int status_ = 0;
};

/// Runs the program to its end.
Finished run_program(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
                     const std::vector<std::string>& environment = {});

/// Standard output and end of a script of bash.
Finished output_of_shell(const std::string& script);

}  // namespace mcdem
