// The extension module mcdem._engine; mcdem/__init__.py is what users import.
#include <fmt/format.h>
#include <pybind11/numpy.h>

#include "cl/opencl.h"
#include "core/errors.h"
#include "core/version.h"
#include "io/run_packing.h"
#include "python/bindings.h"
#include "scene/read_packing.h"

namespace mcdem::inline python {
namespace {

/// Bad input is a ValueError with the text that the program prints; what fails in spite of good input a
/// RuntimeError.
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

/// Before there are threads: two that need NumPy's functions for the first time would wait for each other.
void find_numpy() {
    try {
        pybind11::dtype::of<double>();
    } catch (const pybind11::error_already_set&) {  // said where an array is asked for
    }
}

}  // namespace
}  // namespace mcdem::python

PYBIND11_MODULE(_engine, module) {
    pybind11::register_exception_translator(mcdem::translate);
    mcdem::find_numpy();
    module.attr("__version__") = mcdem::version_text;
    mcdem::read_run_packing = mcdem::packing_of_run;
    mcdem::bind_scene(module);
    mcdem::bind_results(module);
    mcdem::bind_simulation(module);
    mcdem::bind_diagnosis(module);
    mcdem::bind_convergence(module);
    mcdem::bind_comparison(module);
}
