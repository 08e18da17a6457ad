// Top force of each setting at full stroke over a reference setting's: the paper's Rtop column without
// measured data.
#pragma once
#include "metrics/law_range.h"
#include "metrics/levels.h"

namespace mcdem::inline metrics {

struct ModelRow {
    std::string setting;
    std::optional<ContactModel> model;
    Estimate top_force;  ///< at full stroke, or at `reached` [N]
    Estimate ratio;      ///< over the reference setting's; paired over packing seeds where they match
    int replicas = 0;
    int failed = 0;  ///< replicas that stopped before the end of their protocol
    /// Displacement of the last scan where no replica reached full stroke [m].
    std::optional<double> reached = std::nullopt;
    std::optional<BeyondLaw> beyond = std::nullopt;
};

struct ModelTable {
    std::vector<ModelRow> rows;           ///< in the order of the settings
    std::string reference;                ///< label of the setting that ratios are taken over
    double displacement = not_available;  ///< full stroke of the reference setting, or the largest that any
                                          ///< setting reached where the reference stopped early [m]
    double rate_error =
        not_available;  ///< largest that the engine estimated where a tenth of the top force is reached
};

/// Largest estimate where a tenth of the largest load (stress_strain.h) is reached; not-a-number where there
/// is none.
double largest_rate_error(const Replicas& replicas);

/// The reference is the setting of that label; none: the first of model mc_dem, else the first.
ModelTable model_table(const std::vector<Setting>& settings, const LevelOptions& options = {},
                       const std::optional<std::string>& reference = std::nullopt);

}  // namespace mcdem::metrics
