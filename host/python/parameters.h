// Scene keys and their values as Python's.
#pragma once
#include <pybind11/pybind11.h>

#include <map>
#include <string>

namespace mcdem::inline python {

/// Text as Python has it. Bytes that are no UTF-8, of paths for one, stay as os.fsdecode makes them.
pybind11::str python_text(const std::string& text);

/// Texts of a scene's values as int, float, bool or str; None for an empty text.
pybind11::dict typed_parameters(const std::map<std::string, std::string>& parameters);

}  // namespace mcdem::python
