// Data of others that are not part of the project: the measured packing of the paper's authors, and curves
// that LIGGGHTS computed from it. tests/README.md says where to get them. Tests that need them are skipped
// without them.
#pragma once
#include <gtest/gtest.h>

#include <filesystem>

namespace mcdem::reference {

inline const std::filesystem::path authors_folder = std::filesystem::path(MCDEM_SHARED_DATA) / "hydrogel";

}  // namespace mcdem::reference

/// Skips a test if this file of the folder is missing. scripts/skipped recognises the reason by its first
/// words.
#define SKIP_WITHOUT_AUTHORS_DATA(file)                               \
    if (!std::filesystem::exists(reference::authors_folder / (file))) \
    GTEST_SKIP() << "the authors' data are not here (tests/README.md): " << reference::authors_folder / (file)
