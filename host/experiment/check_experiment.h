// Checks what an experiment contains, what is missing, and where it is inconsistent.
#pragma once
#include <string>
#include <vector>

#include "experiment/experiment.h"

namespace mcdem::inline experiment {

enum class Severity {
    note,     ///< available data
    missing,  ///< missing data, and what could be diagnosed with them
    odd,      ///< implausible data: an error in the tables, or a packing that the model does not describe
};

struct Finding {
    Severity severity = Severity::note;
    std::string about;  ///< file
    std::string text;
};

struct ExperimentCheck {
    std::vector<Finding> findings;                         ///< by severity, in the order above
    std::vector<std::string> of(Severity severity) const;  ///< texts of one severity
};

/// Finds nothing odd in the result of `measured` for a simulation that settled at every scan and whose stated
/// diameters and moduli are true. Missing data limit all conclusions.
ExperimentCheck check_experiment(const Experiment& experiment);

}  // namespace mcdem::experiment
