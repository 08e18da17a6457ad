// Converts Python values to TOML, and scene keys and their values to Python.
#pragma once
#include <pybind11/pybind11.h>

#include <map>
#include <string>
#include <vector>

namespace mcdem::inline python {

/// Scene tables with nested or dotted keys as a TOML document. Throws InputError for values without a TOML
/// equivalent.
std::string toml_text(const pybind11::dict& tables);

/// "key=value" for each entry, as for `--set`.
std::vector<std::string> overrides_of(const pybind11::dict& values);

/// Text as a Python str. Invalid UTF-8, for example in paths, is decoded like os.fsdecode.
pybind11::str python_text(const std::string& text);

/// Converts values of scene keys to int, float, bool or str; None for an empty text.
pybind11::dict typed_parameters(const std::map<std::string, std::string>& parameters);

}  // namespace mcdem::python
