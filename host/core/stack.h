#pragma once

namespace mcdem::inline core {

/// Sees that this thread and those started later have a stack of 8 MiB, the usual limit (`ulimit -s 8192`):
/// compilers of kernels need a few hundred KiB, and end by a signal without it. Raises a lower limit. Throws
/// RunError with the remedy if the system refuses.
void expect_enough_stack();

}  // namespace mcdem::core
