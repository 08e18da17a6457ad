// Diagnoses as JSON, written and read; host/diagnose/DIAGNOSIS_OUTPUT.md describes the keys.
#pragma once
#include <string>

#include "diagnose/decide/diagnosis.h"

namespace mcdem::inline diagnose {

/// Name of a verdict in diagnosis.json: no_gap, effect, group, ...
std::string verdict_name(Verdict verdict);

/// Indented JSON with keys in the documented order and a final line feed. Numbers that are not finite become
/// null; invalid UTF-8 becomes replacement characters.
std::string diagnosis_json(const Diagnosis& diagnosis);

/// Inverse of diagnosis_json. Throws InputError that begins with `where` and names the first invalid value.
Diagnosis diagnosis_of_json(const std::string& text, const std::string& where);

}  // namespace mcdem::diagnose
