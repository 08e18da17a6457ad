// Advice for crashes, which may be caused by a compiler or a driver.
#pragma once

namespace mcdem::inline cli {

/// Installs handlers that print the advice for signals of crashes, unless another handler is installed.
/// PoCL's compiler installs some, so call this again after OpenCL has started.
void hint_at_crashes();

}  // namespace mcdem::cli
