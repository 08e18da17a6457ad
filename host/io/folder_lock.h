// The lock on a result folder: one program writes there alone, or several share it.
#pragma once
#include <filesystem>

namespace mcdem::inline io {

/// Held as long as this lives, and given back by the system where its process is killed.
class FolderLock {
public:
    enum class Use { alone, shared };

    /// Does not wait: throws InputError where programs at work in the folder do not go with this use,
    /// RunError where it cannot be opened. One that is alone removes what killed programs left of new files
    /// there (of the folder itself, not those below it). Network disks may have no locks, or only among the
    /// programs of one machine: goes on without.
    FolderLock(const std::filesystem::path& folder, Use use);
    FolderLock(FolderLock&& other) noexcept;
    ~FolderLock();

private:
    int descriptor_ = -1;
};

}  // namespace mcdem::io
