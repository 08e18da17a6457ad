// mcdem.Run, mcdem.Recording and mcdem.Failure
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/parameters.h"

namespace mcdem::inline python {
namespace {

namespace py = pybind11;

/// One recording of a run, which it keeps alive. It is the base of its arrays.
struct OneRecording {
    SharedRun run;
    std::size_t index;
    const Recording& get() const { return run->recordings[index]; }
};

/// Index from 0, or from the end if negative, as in Python.
std::size_t place_in(std::size_t size, py::ssize_t index, const char* what) {
    const auto count = static_cast<py::ssize_t>(size);
    if (index < -count || index >= count)
        throw py::index_error(fmt::format("{} {}: there are {}", what, index, size));
    return static_cast<std::size_t>(index < 0 ? index + count : index);
}

OneRecording recording_at(const SharedRun& run, py::ssize_t index) {
    return {run, place_in(run->recordings.size(), index, "recording")};
}

OneRecording recording_named(const SharedRun& run, const std::string& label) {
    const auto found = std::ranges::find(run->recordings, label, &Recording::label);
    if (found == run->recordings.end()) throw py::key_error(label);
    return {run, static_cast<std::size_t>(found - run->recordings.begin())};
}

const Scan& scan_at(const OneRecording& recording, py::ssize_t index) {
    return recording.get().scans[place_in(recording.get().scans.size(), index, "scan")];
}

/// A property that is an array of the recording's memory.
auto array_property(py::array (*array)(const Recording&, py::handle)) {
    return [array](const py::object& self) { return array(self.cast<const OneRecording&>().get(), self); };
}

py::array stress_array(const Recording& recording, py::handle owner) {
    return tensor_array(recording, &Scan::stress, owner);
}

py::array fabric_array(const Recording& recording, py::handle owner) {
    return tensor_array(recording, &Scan::fabric, owner);
}

auto array_of_scan(py::array (*array)(const Scan&, py::handle)) {
    return [array](const py::object& self, py::ssize_t scan) {
        return array(scan_at(self.cast<const OneRecording&>(), scan), self);
    };
}

void bind_failure(py::module_& module) {
    py::class_<Failure>(module, "Failure", "Why a replica stopped before its protocol ended.")
        .def_readonly("step", &Failure::step)
        .def_readonly("grain", &Failure::grain, "Grain number; -1 where none is to blame.")
        .def_readonly("cause", &Failure::cause)
        .def("__repr__", [](const Failure& self) {
            return fmt::format("<mcdem.Failure at step {}{}: {}>", self.step,
                               self.grain < 0 ? "" : fmt::format(", grain {}", self.grain), self.cause);
        });
}

/// Arrays with one entry per scan.
void bind_scan_arrays(py::class_<OneRecording>& recording) {
    recording
        .def_property_readonly(
            "scans", array_property(scans_array),
            "[S] rows with the fields of /observables in run.h5: frame, cycle, phase (0 load, 1 "
            "unload), settled, time [s], plate_z [m], kinetic_energy [J], elastic_energy [J], "
            " rate_error, coordination_number, mean_force [N], packing_fraction, "
            "branch_length [m].")
        .def_property_readonly(
            "wall_force", array_property(wall_force_array),
            "[S][6][3] force on each wall [N]: x_min, x_max, y_min, y_max, floor, plate. The side "
            "of a cylinder is x_min; walls that are not there have zeros. Of a cell: the forces through "
            "its faces.")
        .def_property_readonly("top_force", array_property(top_force_array),
                               "[S] upward force on the plate [N].")
        .def_property_readonly(
            "strain", array_property(strain_array),
            "[S][6] of a cell, over its lengths at start: compression along x, y and z, shears "
            "xy, xz and yz.")
        .def_property_readonly(
            "stress", array_property(stress_array),
            "[S][3][3] stress of the packing, from contact forces and branch vectors; compression is "
            "positive [Pa]. Not-a-number in files of earlier versions.")
        .def_property_readonly("fabric", array_property(fabric_array),
                               "[S][3][3] mean of n n, n the direction of a contact between grains.");
}

/// Arrays with one entry per grain or contact at one scan.
void bind_single_scans(py::class_<OneRecording>& recording) {
    recording
        .def(
            "grain_stress",
            [](const OneRecording& self, py::ssize_t scan) {
                return grain_stress_array(self.get(), scan_at(self, scan));
            },
            py::arg("scan"),
            "[N][3][3] stress of each grain at a scan, over its own volume; compression is positive [Pa].")
        .def("positions", array_of_scan(position_array), py::arg("scan"),
             "[N][3] centres [m] at a scan; [0][3] where they were not recorded.")
        .def("rotations", array_of_scan(rotation_array), py::arg("scan"),
             "[N][3] rotation of each grain since the start of the run, before the packing relaxes: axis "
             "times "
             "angle, at most pi [rad]; [0][3] where positions were not recorded and in files of earlier "
             "versions.")
        .def("contacts", array_of_scan(contact_array), py::arg("scan"),
             "[C] contacts at a scan: grain, partner (a grain, or -1 to -6: x_min, x_max, y_min, y_max, "
             "floor, plate), "
             "point [3] [m], force [3] on grain [N], overlap [m].");
}

void bind_recording(py::module_& module) {
    py::class_<OneRecording> recording(
        module, "Recording",
        "One packing taken through its protocol: S scans of N grains.\n\n"
        "Arrays are the recording's own memory: read-only, not copied, and good for as "
        "long as one of them is held.");
    bind_scan_arrays(recording);
    bind_single_scans(recording);
    recording.def_property_readonly("label", [](const OneRecording& self) { return self.get().label; })
        .def_property_readonly(
            "parameters", [](const OneRecording& self) { return typed_parameters(self.get().parameters); },
            "Every scene key and its value for this replica; None where the key does not apply.")
        .def_property_readonly(
            "box",
            [](const OneRecording& self) { return std::pair(self.get().box.size_x, self.get().box.size_y); },
            "Size along x and y [m]; of a cylinder its diameter, twice.")
        .def_property_readonly(
            "container", [](const OneRecording& self) { return std::string(name(self.get().box.shape)); },
            "\"box\", \"cylinder\", \"periodic\" or \"cell\". Its walls: the side of a cylinder is x_min, "
            "and "
            "what is not there carries no force; those of a cell are its faces.")
        .def_property_readonly(
            "plate_start", [](const OneRecording& self) { return self.get().plate_start; },
            "Plate position that counts as displacement zero [m].")
        .def_property_readonly("failure", [](const OneRecording& self) { return self.get().failure; })
        .def_property_readonly("diameter", array_property(diameter_array), "[N] diameters [m].")
        .def_property_readonly(
            "species", array_property(species_array),
            "[N] species of each grain, a place in species_names; empty without [[species]].")
        .def_property_readonly("species_names", [](const OneRecording& r) { return r.get().species_names; })
        .def("__len__", [](const OneRecording& self) { return self.get().scans.size(); })
        .def("__repr__", [](const OneRecording& self) {
            return fmt::format("<mcdem.Recording {}: {} scans of {} grains>", self.get().label,
                               self.get().scans.size(), self.get().diameter.size());
        });
}

}  // namespace

void bind_results(py::module_& module) {
    bind_failure(module);
    bind_recording(module);
    py::class_<Run, SharedRun>(module, "Run", "Recordings, one a replica, by number or label.")
        .def_readonly("name", &Run::name)
        .def_readonly("scene", &Run::scene, "The scene's TOML text, with what was overridden.")
        .def_readonly("program", &Run::program, "Version and commit.")
        .def_readonly("device", &Run::device, "Device and driver.")
        .def_readonly("precision", &Run::precision, "float or double.")
        .def("__len__", [](const Run& run) { return run.recordings.size(); })
        .def("__getitem__", &recording_at, py::arg("index"))
        .def("__getitem__", &recording_named, py::arg("label"))
        .def("__iter__",
             [](const SharedRun& run) {
                 py::list all;
                 for (std::size_t r = 0; r < run->recordings.size(); ++r) all.append(OneRecording{run, r});
                 return py::iter(all);
             })
        .def("__repr__", [](const Run& run) {
            return fmt::format("<mcdem.Run {}: {} recordings>", run.name, run.recordings.size());
        });
}

}  // namespace mcdem::python
