// Atomic file writes: a file is written under a temporary name in the same folder and then renamed.
#pragma once
#include <filesystem>
#include <functional>
#include <string_view>

namespace mcdem::inline core {

/// A temporary file with an unpredictable name in the folder of `place`; symbolic links are not followed. The
/// destructor removes it unless put_in_place was called. Every failing operation throws RunError.
class NewFile {
public:
    explicit NewFile(std::filesystem::path place);
    ~NewFile();
    NewFile(const NewFile&) = delete;
    NewFile& operator=(const NewFile&) = delete;

    const std::filesystem::path& place() const { return place_; }
    /// Path until put_in_place.
    const std::filesystem::path& temporary() const { return temporary_; }
    /// Open for reading and writing until close or put_in_place.
    int descriptor() const { return descriptor_; }
    void write(std::string_view bytes);
    /// Flushes to disk and closes.
    void close();
    /// Closes it and renames it to `place`.
    void put_in_place();

private:
    std::filesystem::path place_, temporary_;
    int descriptor_ = -1;
    int lock_ = -1;  ///< keeps the file locked until it is in place
};

/// Creates a new file, lets `write` fill it, and replaces `file` with it. A reader sees the old or the new
/// file, even after a crash or a power failure. If `write` throws, the old file is kept.
void replace_file(const std::filesystem::path& file, const std::function<void(NewFile& out)>& write);

/// The same for a given text. Several programs may write one file at the same time; the last one wins.
void replace_file(const std::filesystem::path& file, std::string_view text);

/// Creates the file with this text, atomically. Returns false if the file exists, also if another program
/// creates it at the same moment.
bool create_file(const std::filesystem::path& file, std::string_view text);

/// Renames `from` to `to` (same folder) and flushes the folder to disk.
void move_file(const std::filesystem::path& from, const std::filesystem::path& to);

/// Removes temporary files and folders that killed programs have left for this path. Those that another
/// program is still writing are locked (flock) and are kept.
void remove_temporaries_of(const std::filesystem::path& file);

/// The same for all files in the folder, without subfolders; does nothing if the folder does not exist.
void remove_temporaries(const std::filesystem::path& folder);

}  // namespace mcdem::core
