// Invariants of the program whose violation would be silent. What users can cause is an InputError or a
// RunError (errors.h).
#pragma once
#include <source_location>
#include <stdexcept>
#include <string>

namespace mcdem::inline core {

/// Throws std::logic_error with the place of the call unless `condition` holds. `what` says what must hold.
inline void expects(bool condition, const char* what,
                    const std::source_location& place = std::source_location::current()) {
    if (!condition)
        throw std::logic_error(std::string(place.file_name()) + ':' + std::to_string(place.line()) + ": " +
                               what);
}

}  // namespace mcdem::core
