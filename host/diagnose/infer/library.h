// What simulations of a scene tell before any experiment is looked at: the scatter of the observation, and
// the signature of every effect and nuisance.
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
        origin;  ///< all that it depends on, by name (ensemble/library_origin.h)
};

/// Which replicates have a mean in common: those of a packing; all of them where a packing has but one.
std::vector<int> mean_groups(const Library& library);

/// Rows less the mean over those of their group, scaled to the variance of one row.
Eigen::MatrixXd apart_from_mean(Eigen::MatrixXd rows, const std::vector<int>& group);

/// Baseline replicates less the mean over those of the same packing, scaled to the variance of one replicate;
/// with one replicate a packing, less the mean over packings.
Eigen::MatrixXd scatter(const Library& library);

/// JSON, to the last bit the same of the same library.
std::string library_text(const Library& library);
/// Written whole or not at all. Throws InputError where the file is there already.
void write_library(const std::filesystem::path& file, const Library& library);
/// Throws InputError where the file is not a library.
Library read_library(const std::filesystem::path& file);

}  // namespace mcdem::diagnose
