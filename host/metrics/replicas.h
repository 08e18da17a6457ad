// Replicas of one setting: recordings that differ only in the seed of their packing.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/recording.h"

namespace mcdem::inline metrics {

/// Pointers into recordings, which must outlive them.
using Replicas = std::vector<const Recording*>;

struct Setting {
    std::string label;  ///< distinguishes it from the run's other settings, e.g. "mc_dem" or "gamma=1.2"
    Replicas replicas;
};

Replicas replicas_of(const std::vector<Recording>& recordings);

/// The run's settings in order of first appearance.
std::vector<Setting> group_by_setting(const Run& run);

/// Whether the recording followed a [[programme]].
bool follows_programme(const Recording& recording);

/// Parameter `packing.seed`; empty if unknown (measured data).
std::string seed_of(const Recording& recording);
std::vector<std::string> seeds_of(const Replicas& replicas);

/// Parameter `contact.model`, if it is known and the same for all.
std::optional<ContactModel> model_of(const Replicas& replicas);

/// Parameter `protocol.discard`: number of first cycles that metrics ignore; 0 if unknown.
int discard_of(const Recording& recording);

}  // namespace mcdem::metrics
