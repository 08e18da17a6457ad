// The folder that a command writes into.
#pragma once
#include "io/folder_lock.h"

namespace mcdem::inline io {

/// Makes the folder where it is missing, and keeps other programs from writing there as long as the lock
/// lives. Removes what killed programs left of new files there and among its simulations. Throws InputError
/// for a file, for the folder of an experiment, and where another program is at work; RunError where it
/// cannot be made or written to.
FolderLock open_output_folder(const std::filesystem::path& folder);

}  // namespace mcdem::io
