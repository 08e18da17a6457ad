// Commands that are written in Python (host/python/mcdem).
#pragma once
#include <string>
#include <vector>

namespace mcdem::inline cli {

/// Runs the module's `__main__` with these arguments and returns its exit code. Its output goes where this
/// program's goes, and an interruption is passed on. Throws RunError where there is no interpreter or no such
/// package.
///
/// Interpreter: MCDEM_PYTHON, else /usr/bin/python3, else python3 of the search path. Package: in the folder
/// MCDEM_PYTHON_FOLDER, else ../share/mcdem/python beside this program, else in the source tree.
int run_python_module(const std::string& module, const std::vector<std::string>& arguments);

}  // namespace mcdem::cli
