#include "cli/run/figures.h"

#include <fmt/format.h>

#include "cli/shell/commands.h"
#include "cli/shell/python_program.h"
#include "core/errors.h"

namespace mcdem::inline cli {

void present(const std::string& name, const std::vector<std::string>& arguments) {
    const int code = run_python_module("mcdem.report." + name, arguments);
    if (code == exit_interrupted) throw Interrupted();
    if (code != exit_done)
        throw RunError(fmt::format(
            "the results are written, but could not all be shown: Python ended with exit code {}", code));
}

}  // namespace mcdem::cli
