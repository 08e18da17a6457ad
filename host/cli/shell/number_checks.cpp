#include <fmt/format.h>

#include <cmath>

#include "cli/shell/commands.h"

namespace mcdem::inline cli {
namespace {

CLI::Validator number_check(const char* in_help, const char* range, bool (*contains)(double)) {
    const auto problem = [=](const std::string& text) {
        double value = 0;
        const bool good = CLI::detail::lexical_cast(text, value) && std::isfinite(value) && contains(value);
        return good ? std::string() : fmt::format("must be a number {}, got {}", range, text);
    };
    return {problem, in_help};
}

}  // namespace

const CLI::Validator& at_least_zero() {
    static const CLI::Validator check =
        number_check("NONNEGATIVE", ">= 0", [](double value) { return value >= 0; });
    return check;
}

const CLI::Validator& above_zero() {
    static const CLI::Validator check =
        number_check("POSITIVE", "> 0", [](double value) { return value > 0; });
    return check;
}

}  // namespace mcdem::cli
