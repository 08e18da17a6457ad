// Files that are whole or not there: written beside their place, then put into it in one move.
#pragma once
#include <filesystem>
#include <functional>
#include <string_view>

namespace mcdem::inline core {

/// A file on its way: written under a random name beside its place, which nobody can foresee and no link is
/// followed from. Goes with its owner unless it was put into place. Every failing operation throws RunError.
class NewFile {
public:
    explicit NewFile(std::filesystem::path place);
    ~NewFile();
    NewFile(const NewFile&) = delete;
    NewFile& operator=(const NewFile&) = delete;

    const std::filesystem::path& place() const { return place_; }
    /// Where it lies until then.
    const std::filesystem::path& temporary() const { return temporary_; }
    /// Open for reading and writing until it is closed.
    int descriptor() const { return descriptor_; }
    void write(std::string_view bytes);
    /// Forces it to the disk.
    void close();
    /// Closes it and moves it to its place.
    void put_in_place();

private:
    std::filesystem::path place_, temporary_;
    int descriptor_ = -1;
    int lock_ = -1;  ///< keeps the file locked until it is in its place
};

/// Lets `write` fill a new file and puts it in place of `file`. A reader sees the old file or the new one,
/// even after a crash or power cut. When `write` throws, the old file stays.
void replace_file(const std::filesystem::path& file, const std::function<void(NewFile& out)>& write);

/// The same for a text that is at hand. Several programs may write one file at a time: the last one stays.
void replace_file(const std::filesystem::path& file, std::string_view text);

/// Puts the text into the file, whole, unless there is such a file: false where there is one, be it that
/// another program was quicker by a moment.
bool create_file(const std::filesystem::path& file, std::string_view text);

/// Moves `from` to `to` (same folder) in one step and forces the folder to the disk.
void move_file(const std::filesystem::path& from, const std::filesystem::path& to);

/// Removes what programs that were killed have left of a new file on its way to this place. Files that
/// another program is still writing are locked (flock) and stay.
void remove_temporaries_of(const std::filesystem::path& file);

/// The same of all files in the folder, not below it; nothing where there is no such folder.
void remove_temporaries(const std::filesystem::path& folder);

}  // namespace mcdem::core
