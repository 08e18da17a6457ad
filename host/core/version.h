#pragma once

namespace mcdem::inline core {

/// "0.1.0 (commit)"; written at every build, see cmake/version.cmake.
extern const char* const version_text;

}  // namespace mcdem::core
