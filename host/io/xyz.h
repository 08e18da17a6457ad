// Grains and contacts for OVITO: extended XYZ, which ASE and others read too, and LAMMPS' `dump local` for
// the bonds.
#pragma once
#include <filesystem>

#include "io/export_choice.h"

namespace mcdem::inline io {

/// Writes `.xyz` and `.contacts.dump` files called by export_name, one frame in each for every
/// chosen scan with positions, and OVITO.txt that says how to look at them; numbers with nine digits. Returns
/// the number of files of grains and contacts: none where there are no positions. Scans are read one by one.
/// Throws InputError and RunError.
int export_xyz(const std::filesystem::path& file_or_folder, const std::filesystem::path& folder,
               const ExportChoice& choice = {});

}  // namespace mcdem::io
