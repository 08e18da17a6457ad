// The parts of guess_tables, each in a file of its name. A guess is sure where a name says it and the numbers
// do not contradict, or where the numbers leave one possibility; unclear where they leave several.
#pragma once
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "experiment/import_experiment.h"

namespace mcdem {

inline Guess guess(std::string word, Sure sure, std::string why) {
    return {{std::move(word)}, sure, std::move(why), 0};
}

/// The entry with every column counting the other way.
inline Guess turned(Guess guess) {
    for (std::string& word : guess.words) word = word.starts_with('-') ? word.substr(1) : "-" + word;
    return guess;
}

/// Role and columns by the names of the columns; units that names state are put into length_unit and
/// force_unit.
void guess_by_names(ImportTable& table);
/// Of a table that names leave open: grains by their geometry.
void guess_grains_by_values(ImportTable& table);
/// Contacts by the forces' directions between the centres of grains.
void guess_contacts_by_values(ImportTable& table, const GrainFrames& grains);
/// A plate's table: a few columns without names, or unclear.
void guess_plate_by_values(ImportTable& table);

/// Which way z counts in the tables of grains: turned round where that is sure, unclear where it may be.
void guess_grains_upwards(std::vector<ImportTable>& tables);
/// The same of a plate's height or displacement, by its rows as they stand.
void guess_plate_downwards(MappedTable& map, const std::vector<Scan>& scans);
/// Unit, origin, diameter or radius of a table of grains.
void guess_grain_lengths(ImportTable& table, const Experiment& known);
/// Numbers, walls, sides, on which of the two a force is, units.
void guess_contact_meaning(ImportTable& table, const GrainFrames& grains, const Experiment& known);
/// What stands for a grain and is none, in the first `most` rows: what the table may call its walls.
std::set<std::string> strangers(const ImportTable& table, const GrainFrames& grains, long offset,
                                std::size_t most, std::string_view key = "");
/// Names these walls, by their words or by the way of their forces.
void set_walls(ImportTable& table, const std::set<std::string>& names, const GrainFrames& grains);
/// Walls that only have a number: where nearly all their forces point one way, that one. Unclear where the
/// grains are not at the wall, for then a grain may be missing.
void guess_walls(ImportTable& table, const ContactFrames& frames, const GrainFrames& grains, const Box& box);
/// Units and sign of the plate's table.
void guess_plate_units(ImportTable& table, const std::vector<ImportTable>& others, const GrainFrames& grains,
                       const Experiment& known);
/// Which frames of the tables belong together.
void guess_frames(std::vector<ImportTable>& tables);

/// Median over grains of the distance to the neighbour that is nearest for the sum of the radii, over that
/// sum: about 1 in a dense packing. `first` grains at most are looked at.
double nearest_over_radii(const std::vector<Vec3>& position, const std::vector<double>& diameter);

/// Of the units those for which `value` in that unit over `scale` lies between `low` and `high`.
std::vector<std::string> fitting_units(std::string_view units, double (*factor)(std::string_view),
                                       double value, double scale, double low, double high);
/// Those that numbers alone may tell: the others are too near to these.
inline constexpr std::string_view length_units = "m cm mm um", force_units = "N mN uN kN gf kgf";

/// Whether Hertz's law tells this unit from its neighbours: with a modulus wrong by three, newtons look like
/// weights in gf or kgf.
inline bool hertz_tells(std::string_view unit) { return unit != "gf" && unit != "kgf"; }

/// Hertz's force of two grains, or of a grain and a rigid wall (radius 0) [N]; not-a-number where E is not
/// known.
double hertz_force(const Experiment& known, double radius, double other, double overlap);

/// The grains of the tables of that role as they stand; empty where they cannot be read yet.
GrainFrames grains_so_far(const std::vector<ImportTable>& tables);

}  // namespace mcdem
