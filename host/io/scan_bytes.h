// Scans as bytes in memory, for checkpoints: a result file of many replicas takes long to write.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "core/recording.h"

namespace mcdem::inline io {

/// The scans and failures of all recordings.
std::vector<std::byte> scan_bytes(const std::vector<Recording>& recordings);

/// Adds them to the same recordings. Throws InputError with `where` if the bytes do not belong to these
/// recordings or hold impossible values.
void add_scans(const std::vector<std::byte>& bytes, std::vector<Recording>& recordings,
               const std::string& where);

}  // namespace mcdem::io
