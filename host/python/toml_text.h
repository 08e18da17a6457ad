// Python's values as TOML.
#pragma once
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

namespace mcdem::inline python {

/// A scene's tables, as nested or dotted keys, as a TOML document. Throws InputError for values that TOML has
/// not.
std::string toml_text(const pybind11::dict& tables);

/// "key=value" for each entry: what `--set` takes.
std::vector<std::string> overrides_of(const pybind11::dict& values);

}  // namespace mcdem::python
