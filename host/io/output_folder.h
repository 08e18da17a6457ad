// The output folder of a command.
#pragma once
#include "io/folder_lock.h"

namespace mcdem::inline io {

/// Creates the folder if necessary and locks it against other programs for the lifetime of the lock. Removes
/// temporary files of killed programs there and in its simulations. Throws InputError for a file, for the
/// folder of an experiment, and if another program uses the folder; RunError if it cannot be created or
/// written.
FolderLock open_output_folder(const std::filesystem::path& folder);

}  // namespace mcdem::io
