// Process limits (ulimit) under which the program or OpenCL drivers crash instead of reporting an error.
#pragma once

namespace mcdem::inline opencl {

/// Raises the limit of open files to the maximum that the system allows. Throws RunError if that is too low.
void expect_enough_open_files();

/// Throws RunError if compiled kernels exceed the limit of the file size.
void expect_room_for_kernels();

/// Throws RunError if the stack is too small. It cannot be raised here: threads of the drivers have the limit
/// of the start of the program.
void expect_enough_stack();

}  // namespace mcdem::opencl
