// What a signature library was made from, and whether that is what a diagnosis needs.
#pragma once
#include <filesystem>
#include <map>
#include <string>

#include "diagnose/infer/library.h"
#include "ensemble/observe_trials.h"

namespace mcdem::inline ensemble {

/// All that signatures and scatter depend on, by name: keys of the scene, the instrument's stated errors, the
/// sizes of grains, the kernels, the program's version and the observables.
std::map<std::string, std::string> library_origin(const Question& question, const Model& model,
                                                  std::size_t grains);

/// Throws InputError that names everything in which the library in `file` was made from something else, with
/// both values. What may differ, and how much, is listed in library_origin.cpp.
void expect_origin(const Library& library, const std::map<std::string, std::string>& needed,
                   const std::filesystem::path& file);

}  // namespace mcdem::ensemble
