#include <fmt/format.h>

#include <cmath>

#include "cli/shell/commands.h"

namespace mcdem::inline cli {

const CLI::Validator& at_least_zero() {
    static const CLI::Validator check(
        [](const std::string& text) {
            double value = 0;
            const bool good = CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value >= 0;
            return good ? std::string() : fmt::format("must be a number >= 0, got {}", text);
        },
        "NONNEGATIVE");
    return check;
}

}  // namespace mcdem::cli
