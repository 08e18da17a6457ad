// Which grain of a packing is of which species.
#pragma once
#include <string>

#include "scene/scene.h"

namespace mcdem::inline scene {

/// Of a packing read from a file: its words for species, where it has some, become places in the replica's
/// list, by name or by number from 1. A file of one word or none goes by the species' fractions, at random
/// with the packing's seed. In a replica without species the words are dropped. Throws InputError.
void assign_species(Packing& packing, const Replica& replica, const std::string& source);

}  // namespace mcdem::scene
