// Selection of the replicas and scans of a run for an export.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "io/results.h"

namespace mcdem::inline io {

/// Numbers of replicas and of scans (Scan::frame); an empty list means all.
struct ExportChoice {
    std::vector<int> replicas = {}, scans = {};

    bool has_replica(std::size_t number) const;
    bool has_scan(int frame) const;
};

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

}  // namespace mcdem::io
