// Stored evidence and findings of the diagnoses of a challenge, so that limits and ablations can be tried
// without new simulations.
#pragma once
#include <filesystem>

#include "diagnose/decide/decision.h"
#include "diagnose/infer/evidence.h"

namespace mcdem::inline challenge {

/// JSON of everything except the library, which all cases of a challenge share.
std::string evidence_text(const Evidence& evidence);
/// Throws InputError if the file is not evidence, or does not match the cells of this library.
Evidence read_evidence(const std::filesystem::path& file, const Library& library);

/// JSON.
std::string findings_text(const Findings& findings);
/// Throws InputError if the file does not contain findings.
Findings read_findings(const std::filesystem::path& file);

}  // namespace mcdem::challenge
