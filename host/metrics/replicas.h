// Replicas of one setting: recordings that differ in nothing but the seed of their packing.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/recording.h"

namespace mcdem::inline metrics {

/// Views: they hold as long as the recordings they came from.
using Replicas = std::vector<const Recording*>;

struct Setting {
    std::string label;  ///< what sets it apart from the run's other settings, e.g. "mc_dem" or "gamma=1.2"
    Replicas replicas;
};

Replicas replicas_of(const std::vector<Recording>& recordings);

/// The run's settings in the order in which they first come.
std::vector<Setting> group_by_setting(const Run& run);

/// Parameter `packing.seed`; empty where it is not known (measured data).
std::string seed_of(const Recording& recording);
std::vector<std::string> seeds_of(const Replicas& replicas);

/// Parameter `contact.model` where it is known and the same for all.
std::optional<ContactModel> model_of(const Replicas& replicas);

/// Parameter `protocol.discard`: the recording's first cycles that metrics leave out; 0 where not known.
int discard_of(const Recording& recording);

}  // namespace mcdem::metrics
