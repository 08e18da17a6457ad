// mcdem._engine.Random: the random numbers of core/random.h, so that draws are the same in both languages.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "core/errors.h"
#include "core/random.h"
#include "python/bindings.h"

namespace mcdem::inline python {
namespace {

namespace py = pybind11;

Stream stream_of(const std::string& name) {
    if (name == "null_draws") return Stream::null_draws;
    if (name == "bootstrap") return Stream::bootstrap;
    if (name == "placebo") return Stream::placebo;
    if (name == "challenge") return Stream::challenge;
    throw InputError("stream: must be one of null_draws, bootstrap, placebo, challenge; got " + name);
}

py::array_t<double> normals(Random& random, py::ssize_t count) {
    py::array_t<double> all(count);
    std::generate_n(all.mutable_data(), count, [&] { return random.normal(); });
    return all;
}

/// The numbers 0 .. count - 1 in random order.
std::vector<int> shuffled(Random& random, int count) {
    std::vector<int> all(static_cast<std::size_t>(count));
    for (int k = 0; k < count; ++k) all[static_cast<std::size_t>(k)] = k;
    random.shuffle(all);
    return all;
}

}  // namespace

void bind_random(py::module_& module) {
    py::class_<Random>(module, "Random", "Random numbers of a seed and a stream.")
        .def(py::init([](std::uint64_t seed, const std::string& stream) {
                 return Random(seed, stream_of(stream));
             }),
             py::arg("seed"), py::arg("stream"))
        .def("uniform", py::overload_cast<double, double>(&Random::uniform), py::arg("low") = 0.0,
             py::arg("high") = 1.0, "Uniform in the open interval (low, high).")
        .def("normals", &normals, py::arg("count"), "Standard normal numbers, one after the other.")
        .def("shuffled", &shuffled, py::arg("count"), "0 .. count - 1 in random order (Fisher & Yates).");
}

}  // namespace mcdem::python
