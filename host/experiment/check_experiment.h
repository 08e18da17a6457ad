// What an experiment holds, lacks and where it contradicts itself: said before anything is concluded from it.
#pragma once
#include <string>
#include <vector>

#include "experiment/experiment.h"

namespace mcdem::inline experiment {

enum class Severity {
    note,     ///< what is there
    missing,  ///< what is not, and what could be told with it
    odd,      ///< what can hardly be so: a slip in the tables, or a packing that the model does not describe
};

struct Finding {
    Severity severity = Severity::note;
    std::string about;  ///< file
    std::string text;
};

struct ExperimentCheck {
    std::vector<Finding> findings;                         ///< by severity in the order above
    std::vector<std::string> of(Severity severity) const;  ///< their texts
};

/// Finds nothing odd in what `measured` gives of a simulation that has settled at every scan, its stated
/// diameters and moduli true. What an experiment lacks (severity missing) limits every conclusion from it.
ExperimentCheck check_experiment(const Experiment& experiment);

}  // namespace mcdem::experiment
