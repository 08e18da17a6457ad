// Early ends of long work.
#pragma once
#include <functional>

namespace mcdem::inline core {

/// Asked again and again during long work, possibly from several threads. After true the work throws
/// Interrupted (core/errors.h), and can be continued.
using StopWanted = std::function<bool()>;
inline bool never_stop() { return false; }

}  // namespace mcdem::core
