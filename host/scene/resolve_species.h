// Species as scenes give them, filled in with what they leave to [grains] and [packing].
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scene/keys.h"

namespace mcdem::inline scene {

/// Tables of diameters, each read once; null where a file cannot be read.
class SizeTables {
public:
    std::shared_ptr<const std::vector<double>> of(const std::string& file);

private:
    std::map<std::string, std::shared_ptr<const std::vector<double>>> tables_;
};

/// Fills in materials, sizes and fractions. With a packing file fractions stay not given where the scene
/// gives none: the file says which grain is of which species. The sizes of all species become those of the
/// generated packing, its smallest, largest and mean diameter. What cannot be filled in stays as it was;
/// species_problems says why.
void resolve_species(Settings& settings, SizeTables& tables);

/// False where some species has no sizes, or fractions, that hold together.
bool has_sizes(const Replica& replica);

}  // namespace mcdem::scene
