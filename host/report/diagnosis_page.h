// The page of a diagnosis: one HTML file that needs nothing else and no network.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "diagnose/diagnosis.h"

namespace mcdem {

/// The SVG files of the three pictures; empty where one could not be drawn for want of data.
struct DiagnosisPictures {
    std::string where, which, how_far;
};

std::string diagnosis_page(const Diagnosis& diagnosis, const DiagnosisPictures& pictures);

/// Draws the pictures where.*, which.* and how_far.* into `folder`, which must exist, and writes
/// diagnosis.html beside them with the same pictures within. Returns the page and the PNG files. Throws
/// RunError where it cannot.
std::vector<std::filesystem::path> write_diagnosis_page(const Diagnosis& diagnosis,
                                                        const std::filesystem::path& folder);

}  // namespace mcdem
