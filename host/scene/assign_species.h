// Assigns a species to each grain of a packing.
#pragma once
#include <string>

#include "scene/scene.h"

namespace mcdem::inline scene {

/// For a packing read from a file. Species names in the file become indices into the replica's list, by name
/// or by number from 1. If the file has no species, or only one word, species are drawn at random according
/// to their fractions, with the packing's seed. If the replica has no species, those of the file are ignored.
/// Throws InputError.
void assign_species(Packing& packing, const Replica& replica, const std::string& source);

}  // namespace mcdem::scene
