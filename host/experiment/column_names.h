// What the name of a column says: a quantity, and perhaps a unit, in the words of laboratories and programs.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "experiment/import_mapping.h"

namespace mcdem {

struct ColumnName {
    std::string base;     ///< small letters and digits only, without the unit: "toppressure"
    std::string unit;     ///< of length_factor, force_factor or time_factor; empty where none is named
    std::string unknown;  ///< what stands in brackets in a unit's place and is none that is known
};

/// "Kraft [mN]", "x_mm" and "z in mm" name units, "c_force[1]" does not.
ColumnName column_name(std::string_view name);

/// Seconds in a unit of time; not-a-number where it is none.
double time_factor(std::string_view unit);

/// `base`, of a column's name, is one of the words in `names`, which stand between blanks. An empty one is
/// none.
bool is_among(const std::string& base, std::string_view names);

/// The key of a table of that role that a column of this name stands for.
std::optional<std::string_view> key_of_name(Role role, const ColumnName& name);

/// It is one of z where that counts downwards, such as a depth.
bool names_downwards(const ColumnName& name);

}  // namespace mcdem
