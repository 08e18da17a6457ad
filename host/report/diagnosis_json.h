// A diagnosis for programs to read; DIAGNOSIS_OUTPUT.md describes the keys.
#pragma once
#include <string>

#include "diagnose/diagnosis.h"

namespace mcdem {

/// The word that stands for a verdict in diagnosis.json: no_gap, effect, group, ...
std::string verdict_name(Verdict verdict);

/// Indented JSON, keys in the documented order, ended by a line feed. Numbers that are not finite become
/// null, bytes that are no UTF-8 replacement characters.
std::string diagnosis_json(const Diagnosis& diagnosis);

}  // namespace mcdem
