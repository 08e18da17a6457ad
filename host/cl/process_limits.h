// The limit of open files (ulimit), below which OpenCL drivers crash instead of reporting an error.
#pragma once

namespace mcdem::inline opencl {

/// Raises the limit of open files to the maximum that the system allows. Throws RunError if that is too low.
void expect_enough_open_files();

}  // namespace mcdem::opencl
