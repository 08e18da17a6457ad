#include "io/output_folder.h"

#include "core/atomic_file.h"
#include "core/output_file.h"
#include "io/result_folder.h"

namespace mcdem::inline io {

FolderLock open_output_folder(const std::filesystem::path& folder) {
    expect_no_experiment(folder);
    make_result_folder(folder);
    FolderLock lock(folder, FolderLock::Use::alone);
    expect_no_experiment(folder);  // may have been created by another program in the meantime
    remove_temporaries(folder / "simulations");
    return lock;
}

}  // namespace mcdem::io
