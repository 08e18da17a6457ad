// Grains and contacts for ParaView, as VTKHDF files (ParaView 5.10, VTK 9.1 or later).
#pragma once
#include <filesystem>

#include "io/export_run.h"

namespace mcdem::inline io {

/// Writes one folder per replica (export_name) with `grains_000000.hdf`, `contacts_000000.hdf`,
/// `forces_000000.hdf`, `walls_000000.hdf`, ..: four files for every selected scan with positions, and a
/// README.txt that explains how to view them. Scans are read one by one. Returns the number of files. Throws
/// InputError and RunError.
int export_vtk(const std::filesystem::path& file_or_folder, const std::filesystem::path& folder,
               const ExportChoice& choice = {});

}  // namespace mcdem::io
