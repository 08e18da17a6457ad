// Origin of a signature library, and whether it fits a diagnosis.
#pragma once
#include <filesystem>
#include <map>
#include <string>

#include "ensemble/diagnosis/build_library.h"

namespace mcdem::inline ensemble {

/// Everything that signatures and scatter depend on, by name: keys of the scene, stated errors of the
/// instrument, sizes of grains, kernels, program version and observables.
std::map<std::string, std::string> library_origin(const TrialSettings& common, const Model& model,
                                                  std::size_t grains);

/// Throws InputError with all differences between the origin of the library in `file` and `needed`, with both
/// values. library_origin.cpp lists allowed differences.
void expect_origin(const Library& library, const std::map<std::string, std::string>& needed,
                   const std::filesystem::path& file);

/// Throws InputError if the library lacks a signature of the plan, or has a different stroke.
void expect_library_of(const Library& library, const Grid& grid, const LibraryPlan& plan,
                       const std::filesystem::path& file);

/// Throws InputError if runs of the scene on the experiment's packing (`baseline`, in the cells of the
/// library) carry a different load than those of the library: at twice the load weight, for example, counts
/// half as much.
void expect_alike_loads(const Library& library, const Eigen::MatrixXd& baseline,
                        const std::filesystem::path& file);

}  // namespace mcdem::ensemble
