// mcdem.Run, mcdem.Recording and mcdem.Failure
#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "core/stress.h"
#include "python/bindings.h"

namespace mcdem::inline python {
namespace {

namespace py = pybind11;

/// An array of `count` contiguous objects: rows of named fields.
template <class Row>
class Fields {
public:
    template <class Member>
    Fields& add(const char* name, const Member Row::*member, const char* format) {
        const Row row{};
        names_.append(name);
        formats_.append(format);
        offsets_.append(reinterpret_cast<const char*>(&(row.*member)) - reinterpret_cast<const char*>(&row));
        return *this;
    }
    py::dtype type() const { return py::dtype(names_, formats_, offsets_, sizeof(Row)); }

private:
    py::list names_, formats_, offsets_;
};

/// Refers to the memory of a recording: read-only, nothing is copied, and `owner` is kept alive.
py::array view(const py::dtype& type, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides,
               const void* data, py::handle owner) {
    py::array array(type, std::move(shape), std::move(strides), data, owner);
    array.attr("setflags")(py::arg("write") = false);
    return array;
}

template <class Row>
py::array rows(const std::vector<Row>& list, const py::dtype& type, py::handle owner) {
    return view(type, {static_cast<py::ssize_t>(list.size())}, {sizeof(Row)}, list.data(), owner);
}

py::dtype scan_type() {
    return Fields<Scan>()
        .add("frame", &Scan::frame, "i4")
        .add("cycle", &Scan::cycle, "i4")
        .add("phase", &Scan::phase, "i4")
        .add("settled", &Scan::settled, "?")
        .add("time", &Scan::time, "f8")
        .add("plate_z", &Scan::plate_z, "f8")
        .add("kinetic_energy", &Scan::kinetic_energy, "f8")
        .add("elastic_energy", &Scan::elastic_energy, "f8")
        .add("wall_work", &Scan::wall_work, "f8")
        .add("weight_work", &Scan::weight_work, "f8")
        .add("damping_loss", &Scan::damping_loss, "f8")
        .add("friction_loss", &Scan::friction_loss, "f8")
        .add("drag_loss", &Scan::drag_loss, "f8")
        .add("energy_error", &Scan::energy_error, "f8")
        .add("rate_error", &Scan::rate_error, "f8")
        .add("coordination_number", &Scan::coordination_number, "f8")
        .add("mean_force", &Scan::mean_force, "f8")
        .add("packing_fraction", &Scan::packing_fraction, "f8")
        .add("branch_length", &Scan::branch_length, "f8")
        .add("max_overlap", &Scan::max_overlap, "f8")
        .type();
}

py::dtype contact_type() {
    return Fields<Contact>()
        .add("grain", &Contact::grain, "i4")
        .add("partner", &Contact::partner, "i4")
        .add("point", &Contact::point, "(3,)f8")
        .add("force", &Contact::force, "(3,)f8")
        .add("overlap", &Contact::overlap, "f8")
        .type();
}

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

constexpr py::ssize_t number = sizeof(double), triple = 3 * number;
static_assert(sizeof(Vec3) == triple && sizeof(Mat3) == 3 * triple && sizeof(Scan::wall_force) == 6 * triple,
              "members of scans are read as rows of numbers");

/// A property that is one member of all scans: [S] and its own extents. `first`: number in the member.
template <class Member>
auto column(Member Scan::*member, std::vector<py::ssize_t> extents = {}, py::ssize_t first = 0) {
    return [=](const py::object& self) {
        const auto& scans = self.cast<const OneRecording&>().get().scans;
        std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(scans.size())}, strides{sizeof(Scan)};
        shape.insert(shape.end(), extents.begin(), extents.end());
        if (extents.size() == 2) strides.push_back(triple);
        if (!extents.empty()) strides.push_back(number);
        const double* data =
            scans.empty() ? nullptr : reinterpret_cast<const double*>(&(scans.front().*member)) + first;
        return view(py::dtype::of<double>(), shape, strides, data, self);
    };
}

/// A property that is one list of the recording, of numbers or of rows.
template <class Row>
auto list_property(std::vector<Row> Recording::*list, py::dtype (*type)()) {
    return [=](const py::object& self) {
        return rows(self.cast<const OneRecording&>().get().*list, type(), self);
    };
}

auto vectors_at(std::vector<Vec3> Scan::*vectors) {
    return [vectors](const py::object& self, py::ssize_t scan) {
        const auto& list = scan_at(self.cast<const OneRecording&>(), scan).*vectors;
        return view(py::dtype::of<double>(), {static_cast<py::ssize_t>(list.size()), 3}, {triple, number},
                    list.data(), self);
    };
}

py::array contacts_at(const py::object& self, py::ssize_t scan) {
    return rows(scan_at(self.cast<const OneRecording&>(), scan).contacts, contact_type(), self);
}

/// [N][3][3], a copy.
py::array grain_stress_at(const OneRecording& self, py::ssize_t scan) {
    const Recording& recording = self.get();
    const auto stress = grain_stress(recording.box, recording.diameter, scan_at(self, scan));
    py::array_t<double> array({static_cast<py::ssize_t>(stress.size()), py::ssize_t{3}, py::ssize_t{3}});
    for (std::size_t i = 0; i < stress.size(); ++i)
        std::copy_n(stress[i].data(), 9, array.mutable_data(static_cast<py::ssize_t>(i), 0, 0));
    return array;
}

void bind_failure(py::module_& module) {
    py::class_<Failure>(module, "Failure", "Why a replica stopped before its protocol ended.")
        .def_readonly("step", &Failure::step)
        .def_readonly("grain", &Failure::grain, "Grain number; -1 where none is to blame.")
        .def_readonly("cause", &Failure::cause)
        .def("__repr__", [](const Failure& self) { return "<mcdem.Failure at " + self.text() + ">"; });
}

void bind_scan_arrays(py::class_<OneRecording>& recording) {
    recording
        .def_property_readonly(
            "scans", list_property(&Recording::scans, scan_type),
            "[S] rows with the fields of /observables in run.h5: frame, cycle, phase (0 load, 1 "
            "unload), settled, time [s], plate_z [m], kinetic_energy [J], elastic_energy [J], "
            "wall_work, weight_work, damping_loss, friction_loss, drag_loss, energy_error (the energy "
            "budget) "
            "[J], rate_error, coordination_number, mean_force [N], packing_fraction, "
            "branch_length [m].")
        .def_property_readonly(
            "wall_force", column(&Scan::wall_force, {6, 3}),
            "[S][6][3] force on each wall [N]: x_min, x_max, y_min, y_max, floor, plate. The side "
            "of a cylinder is x_min; walls that are not there have zeros. Of a cell: the forces through "
            "its faces.")
        .def_property_readonly("top_force",
                               column(&Scan::wall_force, {}, 3 * static_cast<int>(Wall::plate) + 2),
                               "[S] upward force on the plate [N].")
        .def_property_readonly(
            "strain", column(&Scan::strain, {6}),
            "[S][6] of a cell, over its lengths at start: compression along x, y and z, shears "
            "xy, xz and yz.")
        .def_property_readonly(
            "stress", column(&Scan::stress, {3, 3}),
            "[S][3][3] stress of the packing, from contact forces and branch vectors; compression is "
            "positive [Pa]. Not-a-number in files of earlier versions.")
        .def_property_readonly("fabric", column(&Scan::fabric, {3, 3}),
                               "[S][3][3] mean of n n, n the direction of a contact between grains.");
}

/// Arrays with one entry per grain or contact at one scan.
void bind_single_scans(py::class_<OneRecording>& recording) {
    recording
        .def("grain_stress", grain_stress_at, py::arg("scan"),
             "[N][3][3] stress of each grain at a scan, over its own volume; compression is positive [Pa].")
        .def("positions", vectors_at(&Scan::position), py::arg("scan"),
             "[N][3] centres [m] at a scan; [0][3] where they were not recorded.")
        .def("rotations", vectors_at(&Scan::rotation), py::arg("scan"),
             "[N][3] rotation of each grain since the start of the run, before the packing relaxes: axis "
             "times "
             "angle, at most pi [rad]; [0][3] where positions were not recorded and in files of earlier "
             "versions.")
        .def("contacts", contacts_at, py::arg("scan"),
             "[C] contacts at a scan: grain, partner (a grain, or -1 to -6: x_min, x_max, y_min, y_max, "
             "floor, plate), "
             "point [3] [m], force [3] on grain [N], overlap [m].");
}

void bind_recording(py::module_& module) {
    py::class_<OneRecording> recording(
        module, "Recording",
        "One packing simulated through its protocol: S scans of N grains.\n\n"
        "Arrays are the recording's own memory: read-only, not copied, and valid "
        "while a reference to one of them exists.");
    bind_scan_arrays(recording);
    bind_single_scans(recording);
    recording.def_property_readonly("label", [](const OneRecording& self) { return self.get().label; })
        .def_property_readonly(
            "parameters", [](const OneRecording& self) { return parameter_dict(self.get().parameters); },
            "Every scene key and its value for this replica; None where the key does not apply.")
        .def_property_readonly("_parameter_texts",
                               [](const OneRecording& self) {
                                   py::dict all;
                                   for (const auto& [key, value] : self.get().parameters)
                                       all[py::str(key)] = python_text(parameter_text(value));
                                   return all;
                               })
        .def_property_readonly(
            "box",
            [](const OneRecording& self) { return std::pair(self.get().box.size_x, self.get().box.size_y); },
            "Size along x and y [m]; of a cylinder its diameter, twice.")
        .def_property_readonly(
            "container", [](const OneRecording& self) { return std::string(name(self.get().box.shape)); },
            "\"box\", \"cylinder\", \"periodic\" or \"cell\". Its walls: the side of a cylinder is x_min; "
            "missing walls have zero force; those of a cell are its faces.")
        .def_property_readonly(
            "plate_start", [](const OneRecording& self) { return self.get().plate_start; },
            "Plate position that counts as displacement zero [m].")
        .def_property_readonly("failure", [](const OneRecording& self) { return self.get().failure; })
        .def_property_readonly("diameter", list_property(&Recording::diameter, py::dtype::of<double>),
                               "[N] diameters [m].")
        .def_property_readonly(
            "species", list_property(&Recording::species, py::dtype::of<int>),
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
    py::class_<Run, SharedRun>(module, "Run", "Recordings, one per replica, by number or label.")
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
