// Restart points: named blocks of bytes, whose meaning is their writer's, kept whole and checksummed.
#pragma once
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace mcdem::inline io {

struct Checkpoint {
    std::string scene_text;  ///< scene of the run, overrides applied
    std::string device;      ///< bits repeat only on the same device
    int segments = 0;        ///< result segments that came before it; later ones are dropped on resuming
    std::map<std::string, std::vector<std::byte>> fields;
    std::string warning;  ///< set on reading: why an older checkpoint had to be taken; empty otherwise
};

/// Writes `<folder>/checkpoint.h5` and keeps the one before as checkpoint.previous.h5.
void write_checkpoint(const std::filesystem::path& folder, const Checkpoint& checkpoint);

/// The newest checkpoint that is whole; none where none was written. Throws InputError when there are some
/// and all are damaged.
std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& folder);

/// Throws InputError where the file is no checkpoint or does not have its checksum.
void expect_whole_checkpoint(const std::filesystem::path& file);

bool has_checkpoint(const std::filesystem::path& folder);

/// Removes what write_checkpoint wrote: a finished run needs none.
void remove_checkpoints(const std::filesystem::path& folder);

}  // namespace mcdem::io
