// Messages on standard error; each line begins with `mcdem: `.
#pragma once
#include <spdlog/spdlog.h>

#include <exception>

namespace mcdem::inline cli {

/// Must be called first. Afterwards spdlog::info, warn and error print messages for the user.
void set_up_messages();

/// Prints the error, one line per problem, and returns its exit code.
int report_error(const std::exception& error);

}  // namespace mcdem::cli
