// Limits of this process (ulimit) under which OpenCL drivers end the program instead of reporting an error.
#pragma once

namespace mcdem::inline opencl {

/// Raises the limit of open files as far as the system lets it. Throws RunError where that is too few.
void expect_enough_open_files();

/// Throws RunError where compiled kernels are larger than a file may be.
void expect_room_for_kernels();

}  // namespace mcdem::opencl
