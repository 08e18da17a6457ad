// Tables of a laboratory or of another program as an experiment: guessed, then read by a mapping.
#pragma once
#include <string>
#include <vector>

#include "experiment/experiment.h"
#include "experiment/import_tables.h"

namespace mcdem {

/// The tables of a mapping with their files read; problems of all files together. `files`, where there are
/// any, take the place of the mapping's: each goes to the table whose columns it has.
std::vector<ImportTable> read_import_tables(const Mapping& mapping,
                                            const std::vector<std::string>& files = {});

/// Guesses what the tables in these files are, with the box and the materials of `known` as scale (a box of
/// 0: not known). Files that are alike are frames of one table.
std::vector<ImportTable> guess_tables(const std::vector<std::string>& files, const Experiment& known);

/// Units and signs that a guess leaves out are unclear in it.
Mapping mapping_of(const std::vector<ImportTable>& tables);

/// Wrong rows of plate and grains, where the guess knows their columns: they are why it does not know more.
std::vector<std::string> wrong_rows(const std::vector<ImportTable>& tables);

struct Imported {
    Experiment experiment;
    std::vector<std::string> notes;  ///< what was left out or worked out
};

/// Fills `known` (name, box, materials, measurement) with what the tables hold. Throws InputError with every
/// problem, by file and line.
Imported import_tables(const std::vector<ImportTable>& tables, Experiment known);

}  // namespace mcdem
