// The extension module mcdem._engine; users import mcdem/__init__.py.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cstdio>
#include <filesystem>

#include "cl/error_text.h"
#include "cl/kernel_cache.h"
#include "core/errors.h"
#include "core/version.h"
#include "python/bindings.h"

namespace mcdem::inline python {
namespace {

/// Raises the exception of that name in mcdem.errors.
void raise(const char* name, const pybind11::object& what, const SharedRun& run = nullptr) {
    const pybind11::object type = pybind11::module_::import("mcdem.errors").attr(name);
    const pybind11::object error = type(what);
    if (run) error.attr("run") = run;
    PyErr_SetObject(type.ptr(), error.ptr());
}

/// Errors that are reported to the user become those of the package (host/python/mcdem/errors.py).
void translate(std::exception_ptr error) {
    try {
        if (error) std::rethrow_exception(error);
    } catch (const InputError& input) {
        raise("InputError", pybind11::cast(input.problems()));
    } catch (const cl::Error& opencl) {
        raise("DeviceError", pybind11::cast(text_of(opencl)));
    } catch (const AllStopped& all) {
        raise("RunError", pybind11::cast(std::string(all.what())), all.run);
    } catch (const RunError& run) {
        raise("RunError", pybind11::cast(std::string(run.what())));
    } catch (const std::filesystem::filesystem_error& file) {
        raise("RunError", pybind11::cast(file.path1().string() + ": " + file.code().message()));
    }
}

/// Imports NumPy before there are threads: two threads that import it at the same time would deadlock.
void find_numpy() {
    try {
        pybind11::dtype::of<double>();
    } catch (const pybind11::error_already_set&) {  // reported when an array is requested
    }
}

}  // namespace
}  // namespace mcdem::python

PYBIND11_MODULE(_engine, module) {
    pybind11::register_exception_translator(mcdem::translate);
    mcdem::find_numpy();
    module.attr("__version__") = mcdem::version_text;
    mcdem::kernel_cache_refused = [](const std::string& why) {  // perhaps without the GIL
        std::fprintf(stderr, "mcdem: %s\n", why.c_str());
    };
    mcdem::bind_scene(module);
    mcdem::bind_results(module);
    mcdem::bind_simulation(module);
    mcdem::bind_programmes(module);
    mcdem::bind_packings(module);
    mcdem::bind_batch(module);
    mcdem::bind_path(module);
    mcdem::bind_random(module);
}
