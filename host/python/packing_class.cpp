// mcdem._engine.Device, Packing and simulate_starts: what Python simulates for a diagnosis, a calibration, a
// study of convergence and a challenge.
#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>

#include "cl/program.h"
#include "core/random.h"
#include "core/sha256.h"
#include "core/version.h"
#include "ensemble/make_packings.h"
#include "io/results.h"
#include "python/bindings.h"
#include "python/watch.h"
#include "scene/packing/make_packing.h"
#include "scene/packing/neighbour_slots.h"

namespace mcdem::inline python {
namespace {

namespace py = pybind11;
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

Packing packing_of(const Numbers& position, const std::vector<double>& diameter) {
    if (position.ndim() != 2 || position.shape(1) != 3 ||
        position.shape(0) != static_cast<py::ssize_t>(diameter.size()))
        throw py::value_error("position: must have a row of three numbers for each diameter");
    Packing packing;
    packing.diameter = diameter;
    for (py::ssize_t i = 0; i < position.shape(0); ++i)
        packing.position.emplace_back(position.at(i, 0), position.at(i, 1), position.at(i, 2));
    return packing;
}

/// Of everything from which a simulation starts.
std::string digest_of(const Packing& packing) {
    Sha256 digest;
    for (const auto* vectors : {&packing.position, &packing.velocity, &packing.angular_velocity})
        for (const Vec3& vector : *vectors) digest.add(std::span(vector.data(), 3));
    digest.add(packing.diameter);
    for (const TangentialForce& one : packing.tangential)
        digest.add(fmt::format("{} {}", one.grain, one.partner)).add(std::span(one.force.data(), 3));
    return digest.hex();
}

/// A simulation: a scene's first replica, its packing, standard deviations of the noise on coordinates and on
/// diameters [m], and the seed of both noises and of the grains' random properties.
using StartTuple = std::tuple<Scene, Packing, double, double, std::uint64_t>;

bool is_on_last_way_back(const Replica& replica, const Scan& scan) {
    return replica.programme.empty() && scan.phase == Phase::unload &&
           scan.cycle + 1 >= replica.protocol.cycles;
}

/// `end_below`: by replica, or empty: a replica ends where on its last way back the displacement of the plate
/// is less [m].
SharedRun simulate_starts(Device& device, const std::vector<StartTuple>& starts, std::size_t scans,
                          const std::vector<double>& end_below, const Callbacks& callbacks) {
    if (starts.empty() || (!end_below.empty() && end_below.size() != starts.size()))
        throw py::value_error("starts: must be one or more, with as many values of end_below or none");
    Scene batch = std::get<0>(starts.front());
    batch.output.positions = batch.output.contacts = true;
    batch.replicas.clear();
    std::vector<Packing> packings;
    for (const auto& [scene, packing, jitter, diameter_jitter, seed] : starts) {
        batch.replicas.push_back(scene.replicas.front());
        batch.replicas.back().packing.seed = seed;
        packings.push_back(packing);
        apply_jitter(packings.back(), jitter, seed);
        Random random(seed, Stream::diameter_jitter);
        for (double& diameter : packings.back().diameter) diameter += diameter_jitter * random.normal();
        batch.slots = std::max({batch.slots, scene.slots, slots_of(batch.replicas.back(), packings.back())});
    }
    const auto is_enough = [&](std::size_t r, const Recording& recording) {
        const Scan& last = recording.scans.back();
        return !end_below.empty() && is_on_last_way_back(batch.replicas[r], last) &&
               recording.displacement(last) < end_below[r];
    };
    auto run = std::make_shared<Run>(Run{
        batch.name, batch.text, version_text, device.description(), std::string(name(batch.precision)), {}});
    run->recordings = simulate(device, batch, packings, callbacks, {scans, is_enough});
    return run;
}

void bind_simulate(py::module_& module) {
    module.def(
        "make_packings",
        [](const Scene& scene, const std::vector<std::uint64_t>& seeds) {
            Scene all = scene;
            if (!seeds.empty()) all.replicas.clear();
            for (const std::uint64_t seed : seeds) {
                all.replicas.push_back(scene.replicas.front());
                all.replicas.back().packing.seed = seed;
            }
            return watched(py::none(),
                           [&](const auto& callbacks) { return make_packings(all, callbacks.stop_wanted); });
        },
        py::arg("scene"), py::arg("seeds") = std::vector<std::uint64_t>{},
        "The packing of each replica, or of the first replica with each of these seeds.");
    module.def(
        "simulate_starts",
        [](Device& device, const std::vector<StartTuple>& starts, std::optional<std::size_t> scans,
           const std::vector<double>& end_below, py::object progress) {
            return watched(std::move(progress), [&](const auto& callbacks) {
                return simulate_starts(device, starts, scans.value_or(SIZE_MAX), end_below, callbacks);
            });
        },
        py::arg("device"), py::arg("starts"), py::kw_only(), py::arg("scans") = py::none(),
        py::arg("end_below") = std::vector<double>{}, py::arg("progress") = py::none(),
        "Simulates (scene, packing, jitter, diameter jitter, seed) together, with positions and contacts.");
    module.def(
        "write_recording",
        [](const std::filesystem::path& file, const Run& run, std::size_t number) {
            write_run(
                file,
                {run.name, run.scene, run.program, run.device, run.precision, {run.recordings.at(number)}});
        },
        py::arg("file"), py::arg("run"), py::arg("number"), "Writes one recording as a run.");
    module.def(
        "kernels_digest", [] { return Sha256().add(program_text()).hex(); },
        "SHA-256 of the program text of the kernels.");
    module.def("derived_seed", &derived_seed, py::arg("seed"), py::arg("number"));
}

}  // namespace

void bind_packings(py::module_& module) {
    py::class_<Device>(module, "Device", "An OpenCL device with its queue.")
        .def(py::init<const std::string&>(), py::arg("choice") = "")
        .def_property_readonly("description", &Device::description)
        .def_property_readonly("name", [](const Device& device) { return device.info().name; });
    py::class_<Packing>(module, "Packing", "Grains from which a simulation starts.")
        .def(py::init(&packing_of), py::arg("position"), py::arg("diameter"))
        .def("__len__", &Packing::size)
        .def_property_readonly("diameter",
                               [](const Packing& packing) {
                                   return Numbers(static_cast<py::ssize_t>(packing.diameter.size()),
                                                  packing.diameter.data());
                               })
        .def_property_readonly("digest", &digest_of);
    bind_simulate(module);
}

}  // namespace mcdem::python
