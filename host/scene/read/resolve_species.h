// Fills in the values that species take from [grains] and [packing].
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scene/read/keys.h"
#include "scene/scene.h"

namespace mcdem::inline scene {

/// Tables of diameters, each read once; null if a file cannot be read.
class SizeTables {
public:
    std::shared_ptr<const std::vector<double>> of(const std::string& file);

private:
    std::map<std::string, std::shared_ptr<const std::vector<double>>> tables_;
};

/// Fills in materials, sizes and fractions. With a packing file, fractions that the scene does not set remain
/// unset, because the file assigns species to grains. Smallest, largest and mean diameter of the generated
/// packing are set from all species. Values that cannot be filled in are not changed; species_problems
/// reports them.
void resolve_species(Settings& settings, SizeTables& tables);

/// False if a species has no consistent sizes or fractions.
bool has_sizes(const Replica& replica);

/// For a packing read from a file. Species names in the file become indices into the replica's list, by name
/// or by number from 1. If the file has no species, or only one word, species are drawn at random according
/// to their fractions, with the packing's seed. If the replica has no species, those of the file are ignored.
/// Throws InputError.
void assign_species(Packing& packing, const Replica& replica, const std::string& source);

}  // namespace mcdem::scene
