// Converts Python values to TOML.
#pragma once
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

namespace mcdem::inline python {

/// Scene tables with nested or dotted keys as a TOML document. Throws InputError for values without a TOML
/// equivalent.
std::string toml_text(const pybind11::dict& tables);

/// "key=value" for each entry, as for `--set`.
std::vector<std::string> overrides_of(const pybind11::dict& values);

}  // namespace mcdem::python
