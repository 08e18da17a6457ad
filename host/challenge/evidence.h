// What a diagnosis of a challenge rested on and what it found, kept so that limits and ablations can be tried
// without simulating again.
#pragma once
#include <filesystem>

#include "diagnose/decide/decision.h"
#include "diagnose/infer/evidence.h"

namespace mcdem::inline challenge {

/// JSON of all but the library, which the cases of a challenge share.
std::string evidence_text(const Evidence& evidence);
/// Throws InputError where the file is not evidence, or not of this library's cells.
Evidence read_evidence(const std::filesystem::path& file, const Library& library);

/// JSON.
std::string findings_text(const Findings& findings);
/// Throws InputError where the file holds no findings.
Findings read_findings(const std::filesystem::path& file);

}  // namespace mcdem::challenge
