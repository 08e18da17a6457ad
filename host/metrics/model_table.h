// Top force of each setting at full stroke over that of a reference setting: the Rtop column of the paper
// without measured data.
#pragma once
#include "metrics/law_range.h"
#include "metrics/levels.h"

namespace mcdem::inline metrics {

struct ModelRow {
    std::string setting;
    std::optional<ContactModel> model;
    Estimate top_force;  ///< at full stroke, or at `reached` [N]
    Estimate ratio;      ///< over the reference setting; paired by packing seed if seeds match
    int replicas = 0;
    int failed = 0;  ///< replicas that stopped before the end of their protocol
    /// Displacement of the last scan, if no replica reached full stroke [m].
    std::optional<double> reached = std::nullopt;
    std::optional<BeyondLaw> beyond = std::nullopt;
};

struct ModelTable {
    std::vector<ModelRow> rows;           ///< in order of the settings
    std::string reference;                ///< label of the reference setting
    double displacement = not_available;  ///< full stroke of the reference setting, or the largest that any
                                          ///< setting reached if the reference stopped early [m]
    double rate_error =
        not_available;  ///< largest estimate of the engine at or above a tenth of the top force
};

/// Packings that are compressed at different speeds take different courses where grains rearrange. Single
/// scans therefore differ by this much more than the mean over packings, of which `Scan::rate_error` is the
/// estimate; not exceeded by 95 % of the scans of packings of 514 grains (scenes/README.md,
/// scripts/plate_speed).
inline constexpr double course_error = 0.07;

/// Largest estimate at or above a tenth of the largest load (stress_strain.h); NaN if there is none.
double largest_rate_error(const Replicas& replicas);

/// The reference is the setting with that label; default: the first with model mc_dem, otherwise the first.
ModelTable model_table(const std::vector<Setting>& settings,
                       const std::optional<std::string>& reference = std::nullopt);

}  // namespace mcdem::metrics
