// What the name of a column says: a quantity, and perhaps a unit, in the words of laboratories and programs.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "experiment/import_mapping.h"

namespace mcdem {

struct ColumnName {
    std::string base;  ///< small letters and digits only, without the unit: "toppressure"
    std::string unit;  ///< of length_factor or force_factor; empty where none is named
};

/// "Kraft [mN]", "x_mm" and "z in mm" name units, "c_force[1]" does not.
ColumnName column_name(std::string_view name);

/// The key of a table of that role that a column of this name stands for.
std::optional<std::string_view> key_of_name(Role role, const ColumnName& name);

}  // namespace mcdem
