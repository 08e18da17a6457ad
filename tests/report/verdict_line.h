// One of the lines that describe a verdict.
#pragma once
#include <string>

#include "report/diagnosis/diagnosis_text.h"

namespace mcdem {

/// What the verdict says about `about`; empty if nothing.
inline std::string line(const Diagnosis& diagnosis, const std::string& about) {
    for (const auto& [name, says] : verdict_lines(diagnosis))
        if (name == about) return says;
    return "";
}

}  // namespace mcdem
