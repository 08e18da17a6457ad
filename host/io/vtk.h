// Grains and contacts for ParaView, as VTKHDF files (ParaView 5.10, VTK 9.1 or later).
#pragma once
#include <filesystem>

#include "io/export_choice.h"

namespace mcdem::inline io {

/// Writes one folder per replica (export_name) with `grains_000000.hdf`, `contacts_000000.hdf`,
/// `forces_000000.hdf`, `walls_000000.hdf`, ..: four files for every selected scan with positions, and a
/// README.txt that explains how to view them. Scans are read one by one. Returns the number of files. Throws
/// InputError and RunError.
int export_vtk(const std::filesystem::path& file_or_folder, const std::filesystem::path& folder,
               const ExportChoice& choice = {});

/// Displacement of every grain [m]; continuous when it crosses the border of a periodic cell. In a `cell`,
/// displacement beyond the cell's own motion.
struct Displacements {
    std::vector<Vec3> since_last_scan, since_start;  ///< of scans with positions
    std::vector<Vec3> rotation_since_last_scan;      ///< axis times angle [rad]; empty if not recorded
};

/// Grains as points with: grain, diameter; if contacts are known coordination_number, force_magnitude (sum of
/// |force| [N]), stress (core/stress.h), pressure (a third of its trace); displacement and
/// displacement_since_last_scan; if known, rotation (since the start, before the packing relaxes) and
/// rotation_since_last_scan, axis times angle [rad].
void write_vtk_grains(const std::filesystem::path& file, const Recording& recording, const Scan& scan,
                      const Displacements& moved);

/// Contacts as lines from the grain's centre to that of its partner, or to the foot on the wall, with: grain,
/// partner, force (on the grain; also at the ends), force_magnitude, normal_force, tangential_force, overlap.
void write_vtk_contacts(const std::filesystem::path& file, const Recording& recording, const Scan& scan);

/// The same contacts as points at their positions, with the same data on points.
void write_vtk_forces(const std::filesystem::path& file, const Recording& recording, const Scan& scan);

/// vtk_walls.h with: wall (-1: an edge), force (total force on the wall by the grains).
void write_vtk_walls(const std::filesystem::path& file, const Recording& recording, const Scan& scan);

}  // namespace mcdem::io
