// Checks that involve several keys.
#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scene/packing/file_packing.h"
#include "scene/packing/packing_state.h"
#include "scene/read/keys.h"

namespace mcdem::inline scene {

struct CrossProblem {
    std::string key;   ///< the key to change; begins the message
    std::string what;  ///< "must be .., got .."
};

/// Packing files that were read for checks, by path and frame; each is read once.
struct CheckedFile {
    std::size_t count = 0;
    double smallest = 0;  ///< diameter [m]
    FilePacking packing;
    std::optional<DeepestPair> deepest;           ///< if its grains are in their container
    std::map<double, MostNeighbours> neighbours;  ///< by their gap [m]; likewise
    std::vector<std::string> problems;            ///< problems when reading, each with its place
};
using CheckedFiles = std::map<std::pair<std::string, int>, CheckedFile>;

/// Checks one setting. Keys in `bad` already have problems; conditions that involve them are not checked.
std::vector<CrossProblem> cross_problems(const Settings& settings,
                                         const std::set<std::string, std::less<>>& bad);

/// The setting's species must be resolved. `said`: keys that the scene sets or varies. Conditions on keys in
/// `bad`, which already have problems, are not checked.
std::vector<CrossProblem> species_problems(const Settings& settings, const std::set<std::string>& said,
                                           const std::set<std::string, std::less<>>& bad);

/// The same for the stages of the setting's programme.
std::vector<CrossProblem> programme_problems(const Settings& settings, const std::set<std::string>& said,
                                             const std::set<std::string, std::less<>>& bad);

/// Reads the packing file of the setting, if any, and checks that it fits. Problems name lines of the file.
std::vector<std::string> packing_file_problems(const Settings& settings, CheckedFiles& files);

/// Slots that a replica needs (scene/packing/neighbour_slots.h); 0 if it is unknown. Its file must have been
/// checked.
int slots_needed(const Settings& settings, CheckedFiles& files);

/// Number of grains of one replica, and the smallest diameter that they can have [m].
struct GrainsOfReplica {
    std::size_t count = 0;
    double smallest = 0;
};
GrainsOfReplica grains_of(const Settings& settings, const CheckedFiles& files);

}  // namespace mcdem::scene
