// Lock on a result folder, exclusive or shared.
#pragma once
#include <filesystem>

namespace mcdem::inline io {

/// Held during the lifetime of the object; the system releases it if the process is killed.
class FolderLock {
public:
    enum class Use { alone, shared };

    /// Does not wait. Throws InputError if other programs in the folder are incompatible with this use,
    /// RunError if the folder cannot be opened. An exclusive owner removes temporary files of killed programs
    /// (in the folder itself, not in its subfolders). Network file systems may have no locks, or only between
    /// programs on one machine; then work continues without a lock.
    FolderLock(const std::filesystem::path& folder, Use use);
    FolderLock(FolderLock&& other) noexcept;
    ~FolderLock();

private:
    int descriptor_ = -1;
};

}  // namespace mcdem::io
