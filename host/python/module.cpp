// The extension module mcdem._engine; users import mcdem/__init__.py.
#include <fmt/format.h>
#include <pybind11/numpy.h>

#include "cl/opencl.h"
#include "core/errors.h"
#include "core/version.h"
#include "io/run_packing.h"
#include "python/bindings.h"
#include "scene/packing/read_packing.h"

namespace mcdem::inline python {
namespace {

/// InputError becomes ValueError with the message of the program; other failures become RuntimeError.
void translate(std::exception_ptr error) {
    try {
        if (error) std::rethrow_exception(error);
    } catch (const InputError& input) {
        PyErr_SetString(PyExc_ValueError, input.what());
    } catch (const cl::Error& opencl) {
        PyErr_SetString(PyExc_RuntimeError,
                        fmt::format("OpenCL: {} failed with code {}", opencl.what(), opencl.err()).c_str());
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
    mcdem::read_run_packing = mcdem::recorded_packing;
    mcdem::bind_scene(module);
    mcdem::bind_results(module);
    mcdem::bind_simulation(module);
    mcdem::bind_diagnosis(module);
    mcdem::bind_comparison(module);
    mcdem::bind_path(module);
}
