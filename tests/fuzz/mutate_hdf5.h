// Changes the structure of a valid HDF5 file: objects, shapes, types, values, attributes, links.
#pragma once
#include <filesystem>

#include "fuzz/byte_source.h"

namespace mcdem::fuzz {

/// Makes a few changes, as many as `source` has bytes for.
void mutate_hdf5(const std::filesystem::path& file, ByteSource& source);

}  // namespace mcdem::fuzz
