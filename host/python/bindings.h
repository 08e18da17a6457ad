// The parts of the Python module; mcdem/__init__.pyi contains the Python signatures.
#pragma once
#include <pybind11/pybind11.h>

#include <map>
#include <memory>
#include <string>

#include "core/errors.h"
#include "core/recording.h"

namespace mcdem::inline python {

void bind_scene(pybind11::module_& module);
void bind_results(pybind11::module_& module);
void bind_simulation(pybind11::module_& module);
void bind_batch(pybind11::module_& module);
void bind_packings(pybind11::module_& module);
void bind_programmes(pybind11::module_& module);
void bind_path(pybind11::module_& module);
void bind_random(pybind11::module_& module);

/// Values of scene keys as int, float, bool or str; None where they are not given.
pybind11::dict parameter_dict(const Parameters& parameters);

/// Invalid UTF-8, for example in paths, is decoded like os.fsdecode.
pybind11::str python_text(const std::string& text);

/// Values of scene keys as TOML text, by key.
using KeyValues = std::map<std::string, std::string>;
/// From a dict of dotted keys. Throws InputError.
KeyValues key_values(const pybind11::dict& values);

/// A run in Python: shared by arrays and recordings, immutable.
using SharedRun = std::shared_ptr<Run>;

/// All replicas of a run stopped early; in Python the error has their recordings as `run`.
struct AllStopped : RunError {
    AllStopped(const std::string& causes, SharedRun run)
        : RunError("all replicas stopped early:\n" + causes), run(std::move(run)) {}
    SharedRun run;
};

}  // namespace mcdem::python
