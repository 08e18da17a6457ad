// Checkpoints: named byte arrays; only the writer knows their meaning.
#pragma once
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace mcdem::inline io {

struct Checkpoint {
    std::string scene_text;  ///< scene of the run, with overrides
    std::string device;      ///< results are bit-identical only on the same device
    int segments = 0;        ///< number of result segments before it; later ones are discarded on resuming
    std::map<std::string, std::vector<std::byte>> fields;
};

/// Writes `<folder>/checkpoint.h5`.
void write_checkpoint(const std::filesystem::path& folder, const Checkpoint& checkpoint);

/// The checkpoint; none if none was written. Throws InputError if it is damaged.
std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& folder);

bool has_checkpoint(const std::filesystem::path& folder);

/// Removes the checkpoint when a run is finished.
void remove_checkpoint(const std::filesystem::path& folder);

}  // namespace mcdem::io
