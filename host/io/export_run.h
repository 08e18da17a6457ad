// Export of a run's grains and contacts for other programs, and shared code of the formats.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/recording.h"
#include "io/results.h"

namespace mcdem::inline io {

struct ExportFormats {
    bool vtk = false, xyz = false;
};

/// Numbers of replicas and of scans (Scan::frame); an empty list means all.
struct ExportChoice {
    std::vector<int> replicas = {}, scans = {};

    bool has_replica(std::size_t number) const;
    bool has_scan(int frame) const;
};

/// Exports a result folder or file into a folder, which is created. Returns the number of files of grains and
/// contacts. Throws InputError if no format is selected or there is nothing to export; RunError.
int export_run(const std::filesystem::path& run, const std::filesystem::path& folder,
               const ExportFormats& formats, const ExportChoice& choice);

/// Grains and contacts for ParaView, as VTKHDF files (ParaView 5.10, VTK 9.1 or later). Writes one folder per
/// replica (export_name) with `grains_000000.hdf`, `contacts_000000.hdf`, `forces_000000.hdf`,
/// `walls_000000.hdf`, ..: four files for every selected scan with positions, and a README.txt that explains
/// how to view them. Scans are read one by one. Returns the number of files. Throws InputError and RunError.
int export_vtk(const std::filesystem::path& file_or_folder, const std::filesystem::path& folder,
               const ExportChoice& choice = {});

/// The same for OVITO: extended XYZ, which ASE and other programs also read, and `dump local` of LAMMPS for
/// the bonds. Writes `.xyz` and `.contacts.dump` files named by export_name, with one frame for every
/// selected scan with positions, and OVITO.txt; numbers have nine digits. The number of files is 0 if there
/// are no positions.
int export_xyz(const std::filesystem::path& file_or_folder, const std::filesystem::path& folder,
               const ExportChoice& choice = {});

/// Name of a replica's files or folder: its number and its label, reduced to characters that are safe in all
/// file systems and shells: "replica_00003_mc_dem_friction=0.03_2".
std::string export_name(std::size_t number, const std::string& label);

/// A text file that explains how to view an export; the list of replicas is appended to it.
struct ExportGuide {
    const char* name;
    const char* text;
};
/// Writes the files of one replica into a folder; returns their number.
using ExportReplica = std::function<int(RunReader& reader, std::size_t replica,
                                        const std::filesystem::path& folder, const ExportChoice& choice)>;

/// Exports the selected replicas and the guide; returns the number of files without the guide. Throws
/// InputError if a selected replica does not exist.
int export_replicas(const std::filesystem::path& file_or_folder, const std::filesystem::path& folder,
                    const ExportChoice& choice, const ExportGuide& guide,
                    const ExportReplica& export_replica);

/// Contacts and forces of one grain.
struct GrainLoad {
    int contacts = 0;                ///< including walls
    double force_magnitude = 0;      ///< sum over all contacts [N]
    Vec3 wall_force = Vec3::Zero();  ///< total force by walls [N]
};

/// By grain; all zero if contacts were not recorded.
std::vector<GrainLoad> grain_loads(const Scan& scan);

}  // namespace mcdem::io
