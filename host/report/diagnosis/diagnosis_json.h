// A diagnosis for programs to read, and read again; DIAGNOSIS_OUTPUT.md describes the keys.
#pragma once
#include <string>

#include "diagnose/decide/diagnosis.h"

namespace mcdem::inline report {

/// The word that stands for a verdict in diagnosis.json: no_gap, effect, group, ...
std::string verdict_name(Verdict verdict);

/// Indented JSON, keys in the documented order, ended by a line feed. Numbers that are not finite become
/// null, bytes that are no UTF-8 replacement characters.
std::string diagnosis_json(const Diagnosis& diagnosis);

/// The diagnosis that such a text was made from. Throws InputError that begins with `where` and names the
/// first thing that is not as it must be.
Diagnosis diagnosis_of_json(const std::string& text, const std::string& where);

}  // namespace mcdem::report
