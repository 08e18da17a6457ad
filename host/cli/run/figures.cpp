#include "cli/run/figures.h"

#include <fmt/format.h>

#include "cli/shell/commands.h"
#include "cli/shell/python_program.h"
#include "core/errors.h"
#include "core/output_file.h"

namespace mcdem::inline cli {
namespace {

namespace fs = std::filesystem;

const char* const values_file = "figures.json";

void run_python(const std::string& module, const std::vector<std::string>& arguments,
                const std::string& failed) {
    const int code = run_python_module(module, arguments);
    if (code == exit_interrupted) throw Interrupted();
    if (code != exit_done) throw RunError(fmt::format("{}: Python ended with exit code {}", failed, code));
}

}  // namespace

void expect_replaceable_figures(const fs::path& folder, const std::vector<std::string>& names) {
    expect_replaceable(folder / values_file, FileKind::figure_values);
    for (const auto& name : names)
        for (const char* ending : {".pdf", ".png", ".svg"})
            expect_replaceable(folder / (name + ending), FileKind::figure);
}

void present(const std::string& name, const std::vector<std::string>& arguments) {
    run_python("mcdem.report." + name, arguments, "the results are written, but could not all be shown");
}

}  // namespace mcdem::cli
