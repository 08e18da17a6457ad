// Where simulation and experiment differ, in words.
#pragma once
#include <string>

#include "diagnose/decide/diagnosis.h"

namespace mcdem::inline report {

/// The strongest entry of each observable, a few of them. Without entries: single cells beyond the threshold,
/// so that the text agrees with the figure.
std::string where_line(const Diagnosis& diagnosis);

}  // namespace mcdem::report
