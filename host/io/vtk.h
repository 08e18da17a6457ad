// Grains and contacts for ParaView, as VTKHDF files (ParaView 5.10, VTK 9.1 or later).
#pragma once
#include <filesystem>

#include "io/export_choice.h"

namespace mcdem::inline io {

/// Writes a folder a replica (export_name) with `grains_000000.hdf`, `contacts_000000.hdf`,
/// `forces_000000.hdf` and `walls_000000.hdf`, .., four files for every scan with positions that is chosen,
/// and a README.txt that says how to look at them. Scans are read one by one. Returns the number of files.
/// Throws InputError and RunError.
int export_vtk(const std::filesystem::path& file_or_folder, const std::filesystem::path& folder,
               const ExportChoice& choice = {});

/// How far every grain has come [m]; without a jump where it crosses the border of a periodic cell. In a
/// cell, beyond the cell's own motion.
struct Displacements {
    std::vector<Vec3> since_last_scan, since_start;  ///< of scans with positions
    std::vector<Vec3> rotation_since_last_scan;      ///< axis times angle [rad]; empty where not recorded
};

/// Grains as points with: grain, diameter, where contacts are known coordination_number, force_magnitude (sum
/// of |force| [N]), stress (core/stress.h), pressure (a third of its trace), displacement and
/// displacement_since_last_scan; rotation (since the start, before the packing relaxes) and
/// rotation_since_last_scan where they are known, axis times angle [rad].
void write_vtk_grains(const std::filesystem::path& file, const Recording& recording, const Scan& scan,
                      const Displacements& moved);

/// Contacts as lines from the grain's centre to its partner's, or to the foot on the wall, with: grain,
/// partner, force (on the grain; at the ends too), force_magnitude, normal_force, tangential_force, overlap.
void write_vtk_contacts(const std::filesystem::path& file, const Recording& recording, const Scan& scan);

/// The same contacts as points where they are, with the same data on points.
void write_vtk_forces(const std::filesystem::path& file, const Recording& recording, const Scan& scan);

/// vtk_walls.h with: wall (-1: an edge), force (on the whole wall by the grains).
void write_vtk_walls(const std::filesystem::path& file, const Recording& recording, const Scan& scan);

}  // namespace mcdem::io
