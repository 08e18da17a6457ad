// mcdem._engine.Batch: variants of a scene on the same packings, simulated together in memory.
#include <pybind11/stl.h>

#include "core/version.h"
#include "ensemble/make_packings.h"
#include "python/bindings.h"
#include "python/watch.h"
#include "scene/read/change_scene.h"

namespace mcdem::inline python {
namespace {

namespace py = pybind11;

class Batch {
public:
    Batch(const Scene& scene, const std::string& device, const StopWanted& stop_wanted)
        : device_(device), scene_(scene), packings_(make_packings(scene, stop_wanted)) {}

    std::size_t packings() const { return packings_.size(); }
    /// Of all grains [m].
    double mean_diameter() const {
        double sum = 0, count = 0;
        for (const Packing& packing : packings_)
            for (const double diameter : packing.diameter) sum += diameter, count += 1;
        return sum / count;
    }
    std::string device_name() const { return device_.info().name; }

    /// For each of `changes` all replicas of the scene with these values.
    SharedRun simulate(const std::vector<KeyValues>& changes, std::size_t scans, const Callbacks& callbacks) {
        Scene all = scene_;
        all.replicas.clear();
        std::vector<Packing> packings;
        for (const KeyValues& values : changes) {
            const Scene changed = with_changes(scene_, values);
            all.precision = changed.precision;
            all.output = changed.output;
            all.slots = changed.slots;
            all.replicas.insert(all.replicas.end(), changed.replicas.begin(), changed.replicas.end());
            packings.insert(packings.end(), packings_.begin(), packings_.end());
        }
        auto run = std::make_shared<Run>(Run{
            all.name, all.text, version_text, device_.description(), std::string(name(all.precision)), {}});
        run->recordings = mcdem::simulate(device_, all, packings, callbacks, {.scans = scans});
        return run;
    }

private:
    Device device_;
    Scene scene_;
    std::vector<Packing> packings_;
};

}  // namespace

void bind_batch(py::module_& module) {
    py::class_<Batch>(module, "Batch", "Variants of a scene on the same packings.")
        .def(py::init([](const Scene& scene, const std::string& device) {
                 return watched(py::none(), [&](const auto& options) {
                     return std::make_unique<Batch>(scene, device, options.stop_wanted);
                 });
             }),
             py::arg("scene"), py::arg("device"))
        .def_property_readonly("packings", &Batch::packings)
        .def_property_readonly("mean_diameter", &Batch::mean_diameter)
        .def_property_readonly("device_name", &Batch::device_name)
        .def(
            "simulate",
            [](Batch& batch, const py::list& changes, std::size_t scans, py::object progress) {
                std::vector<KeyValues> all;
                for (const py::handle& values : changes) all.push_back(key_values(values.cast<py::dict>()));
                return watched(std::move(progress),
                               [&](const auto& options) { return batch.simulate(all, scans, options); });
            },
            py::arg("changes"), py::arg("scans"), py::arg("progress") = py::none());
}

}  // namespace mcdem::python
