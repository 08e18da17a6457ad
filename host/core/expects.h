// Invariants of the program whose violation would be silent. What users can cause is an InputError or a
// RunError (errors.h).
#pragma once
#include <stdexcept>
#include <string>

namespace mcdem::inline core {

/// Throws std::logic_error with the place of the call unless `condition` holds. `what` says what must hold.
/// The built-in functions are those of GCC and Clang; std::source_location needs Clang 16.
inline void expects(bool condition, const char* what, const char* file = __builtin_FILE(),
                    int line = __builtin_LINE()) {
    if (!condition) throw std::logic_error(std::string(file) + ':' + std::to_string(line) + ": " + what);
}

}  // namespace mcdem::core
