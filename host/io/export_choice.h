// Which replicas and scans of a run are exported, and where to.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "io/results.h"

namespace mcdem::inline io {

/// Numbers of replicas and of scans (Scan::frame); an empty list stands for all.
struct ExportChoice {
    std::vector<int> replicas = {}, scans = {};

    bool has_replica(std::size_t number) const;
    bool has_scan(int frame) const;
};

/// What a replica's files or folder are called: its number and its label, of which only characters are taken
/// that every file system and shell leaves alone: "replica_00003_mc_dem_friction=0.03_2".
std::string export_name(std::size_t number, const std::string& label);

/// A text file that says how to look at an export; what replicas are there is added to it.
struct ExportGuide {
    const char* name;
    const char* text;
};
/// Writes the files of one replica into a folder; returns how many.
using ExportReplica = std::function<int(RunReader& reader, std::size_t replica,
                                        const std::filesystem::path& folder, const ExportChoice& choice)>;

/// Exports the replicas of a choice, the guide beside them; returns the number of files, guide not counted.
/// Throws InputError where a replica is chosen that the run has not.
int export_replicas(const std::filesystem::path& file_or_folder, const std::filesystem::path& folder,
                    const ExportChoice& choice, const ExportGuide& guide,
                    const ExportReplica& export_replica);

}  // namespace mcdem::io
