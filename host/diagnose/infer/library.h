// Simulation results of a scene that do not depend on an experiment: the scatter of the observation, and the
// signature of every effect and nuisance.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "diagnose/infer/signature.h"
#include "diagnose/observe/observation.h"

namespace mcdem::inline diagnose {

struct Library {
    Grid grid;
    Eigen::MatrixXd baseline;  ///< row: replicate, column: cell
    std::vector<int> packing;  ///< of each replicate
    std::vector<Signature> effects;
    std::vector<Signature> nuisances;
    std::map<std::string, std::string> provenance;  ///< scene, program, device
    std::map<std::string, std::string>
        origin;  ///< everything that it depends on, by name (ensemble/diagnosis/library_origin.h)
};

/// Groups of replicates with a common mean: those of a packing, or all of them if every packing has only one.
std::vector<int> mean_groups(const Library& library);

/// Rows minus the mean of their group, scaled to the variance of one row.
Eigen::MatrixXd apart_from_mean(Eigen::MatrixXd rows, const std::vector<int>& group);

/// Baseline replicates minus the mean over those of the same packing, scaled to the variance of one
/// replicate. With one replicate per packing the mean over packings is subtracted.
Eigen::MatrixXd scatter(const Library& library);

/// JSON text; bit-identical for the same library.
std::string library_text(const Library& library);
/// Writes the complete file or nothing. Returns false if the file exists; it is not replaced.
bool write_library(const std::filesystem::path& file, const Library& library);
/// Throws InputError if the file is not a library.
Library read_library(const std::filesystem::path& file);

}  // namespace mcdem::diagnose
