// What the program says on standard error: each line begins with `mcdem: `.
#pragma once
#include <spdlog/spdlog.h>

#include <exception>

namespace mcdem::inline cli {

/// Must come first. From then on spdlog::info, warn and error speak to the user.
void set_up_messages();

/// Says what went wrong, each problem on its line, and returns the exit code that stands for it.
int report_error(const std::exception& error);

}  // namespace mcdem::cli
