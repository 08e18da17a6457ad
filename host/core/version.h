#pragma once

namespace mcdem {

/// "0.1.0 (commit)"; written at every build, see cmake/version.cmake.
extern const char* const version_text;

}  // namespace mcdem
