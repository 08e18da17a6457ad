// Grains and contacts for ParaView, as VTKHDF files (ParaView 5.10, VTK 9.1 or later).
#pragma once
#include <filesystem>

#include "core/recording.h"

namespace mcdem::inline io {

/// Writes `<folder>/replica_00000/grains_000000.hdf` and `contacts_000000.hdf`, .., one pair for every scan
/// with positions, and a README.txt that says how to look at them. Returns the number of files.
int export_vtk(const Run& run, const std::filesystem::path& folder);

/// The same from a result file or folder, scan by scan, for runs larger than memory.
int export_vtk(const std::filesystem::path& file_or_folder, const std::filesystem::path& folder);

/// Grains as points with: grain, diameter, coordination_number, force_magnitude (sum of |force| [N]).
void write_vtk_grains(const std::filesystem::path& file, const Recording& recording, const Scan& scan);

/// Contacts as lines from the grain's centre to its partner's, or to the foot on the wall, with: grain,
/// partner, force (on the grain), force_magnitude, overlap.
void write_vtk_contacts(const std::filesystem::path& file, const Recording& recording, const Scan& scan);

}  // namespace mcdem::io
