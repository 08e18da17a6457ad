// Grains and contacts for OVITO: extended XYZ, which ASE and other programs also read, and `dump local` of
// LAMMPS for the bonds.
#pragma once
#include <filesystem>

#include "io/export_run.h"

namespace mcdem::inline io {

/// Writes `.xyz` and `.contacts.dump` files named by export_name, with one frame for every selected scan with
/// positions, and OVITO.txt that explains how to view them; numbers have nine digits. Returns the number of
/// files of grains and contacts: none if there are no positions. Scans are read one by one. Throws InputError
/// and RunError.
int export_xyz(const std::filesystem::path& file_or_folder, const std::filesystem::path& folder,
               const ExportChoice& choice = {});

}  // namespace mcdem::io
