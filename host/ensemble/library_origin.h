// What a signature library was made from, and whether that is what a diagnosis needs.
#pragma once
#include <filesystem>
#include <map>
#include <string>

#include "ensemble/build_library.h"

namespace mcdem::inline ensemble {

/// All that signatures and scatter depend on, by name: keys of the scene, the instrument's stated errors, the
/// sizes of grains, the kernels, the program's version and the observables.
std::map<std::string, std::string> library_origin(const Question& question, const Model& model,
                                                  std::size_t grains);

/// Throws InputError that names everything in which the library in `file` was made from something else, with
/// both values. What may differ, and how much, is listed in library_origin.cpp.
void expect_origin(const Library& library, const std::map<std::string, std::string>& needed,
                   const std::filesystem::path& file);

/// Throws InputError where the library lacks a signature that the plan wants, or is of another stroke.
void expect_library_of(const Library& library, const Grid& grid, const LibraryPlan& plan,
                       const std::filesystem::path& file);

/// Throws InputError where runs of the scene on the experiment's packing (`baseline`, in the library's cells)
/// carry another load than those of the library: weight, say, counts half as much at twice the load.
void expect_alike_loads(const Library& library, const Eigen::MatrixXd& baseline,
                        const std::filesystem::path& file);

}  // namespace mcdem::ensemble
