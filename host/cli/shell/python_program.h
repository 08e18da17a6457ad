// Commands that are written in Python (host/python/mcdem).
#pragma once
#include <string>
#include <vector>

namespace mcdem::inline cli {

/// Runs the module's `__main__` with these arguments and returns its exit code. It inherits the output
/// streams, and interruptions are passed on. No code of the current folder is run
/// (host/python/mcdem/start.py). A signal that ends it ends this process, too. Throws RunError if there is no
/// interpreter or package.
///
/// Interpreter: MCDEM_PYTHON, otherwise /usr/bin/python3, otherwise python3 in an absolute folder of the
/// search path. Package: in the folder MCDEM_PYTHON_FOLDER, otherwise where Python's packages are installed
/// (../lib/python3*/ relative to this program), otherwise ../share/mcdem/python, the build folder or the
/// source tree.
int run_python_module(const std::string& module, const std::vector<std::string>& arguments);

}  // namespace mcdem::cli
