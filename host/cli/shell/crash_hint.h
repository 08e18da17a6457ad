// What to do when the program is ended by a defect, which may be a compiler's or a driver's.
#pragma once

namespace mcdem::inline cli {

/// Says it after the signals by which such an end comes, where nobody else listens to them. PoCL's compiler
/// does, so this is to be called again once OpenCL has started.
void hint_at_crashes();

}  // namespace mcdem::cli
