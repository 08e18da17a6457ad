// mcdem._engine.Experiment: a measured compression (experiment/experiment.h) from values of Python, and the
// instrument.
#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "core/errors.h"
#include "diagnose/observe/compared_forces.h"
#include "experiment/instrument.h"
#include "python/bindings.h"
#include "scene/read/keys.h"

namespace mcdem::inline python {
namespace {

namespace py = pybind11;
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Wholes = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

Vec3 row_of(const Numbers& rows, py::ssize_t row) {
    return {rows.at(row, 0), rows.at(row, 1), rows.at(row, 2)};
}

std::vector<Vec3> vectors_of(const py::handle& values) {
    const auto rows = values.cast<Numbers>();
    std::vector<Vec3> vectors;
    for (py::ssize_t i = 0; i < rows.shape(0); ++i) vectors.push_back(row_of(rows, i));
    return vectors;
}

/// From a pair (contacts: grain, partner; point, force) of arrays.
std::vector<Contact> contacts_of(const py::handle& values) {
    const auto [grain, partner, point, force] = values.cast<std::tuple<Wholes, Wholes, Numbers, Numbers>>();
    std::vector<Contact> contacts;
    for (py::ssize_t i = 0; i < grain.shape(0); ++i)
        contacts.push_back({static_cast<int>(grain.at(i)), static_cast<int>(partner.at(i)), row_of(point, i),
                            row_of(force, i), unknown});
    return contacts;
}

std::vector<Scan> scans_of(const py::dict& fields) {
    const auto cycle = fields["cycle"].cast<Wholes>(), phase = fields["phase"].cast<Wholes>();
    const auto time = fields["time"].cast<Numbers>(), plate_z = fields["plate_z"].cast<Numbers>(),
               wall_force = fields["wall_force"].cast<Numbers>(),
               coordination_number = fields["coordination_number"].cast<Numbers>(),
               mean_force = fields["mean_force"].cast<Numbers>(),
               branch_length = fields["branch_length"].cast<Numbers>();
    const auto position = fields["position"].cast<py::sequence>(),
               contacts = fields["contacts"].cast<py::sequence>();
    std::vector<Scan> scans(static_cast<std::size_t>(cycle.shape(0)));
    for (py::ssize_t s = 0; s < cycle.shape(0); ++s) {
        Scan& scan = scans[static_cast<std::size_t>(s)];
        scan.frame = static_cast<int>(s);
        scan.cycle = static_cast<int>(cycle.at(s));
        scan.phase = static_cast<Phase>(phase.at(s));
        scan.time = time.at(s);
        scan.plate_z = plate_z.at(s);
        for (int wall = 0; wall < wall_count; ++wall)
            for (int axis = 0; axis < 3; ++axis)
                scan.wall_force[static_cast<std::size_t>(wall)][axis] = wall_force.at(s, wall, axis);
        scan.kinetic_energy = scan.elastic_energy = scan.packing_fraction = unknown;
        scan.coordination_number = coordination_number.at(s);
        scan.mean_force = mean_force.at(s);
        scan.branch_length = branch_length.at(s);
        scan.settled = true;
        scan.position = vectors_of(position[static_cast<std::size_t>(s)]);
        scan.contacts = contacts_of(contacts[static_cast<std::size_t>(s)]);
    }
    return scans;
}

/// What is used as an index later.
void expect_consistent(const Recording& recording) {
    const auto grains = static_cast<int>(recording.diameter.size());
    const auto is_grain = [&](int number) { return number >= 0 && number < grains; };
    for (const Scan& scan : recording.scans) {
        bool good = scan.phase == Phase::load || scan.phase == Phase::unload;
        good = good && (scan.position.empty() || scan.position.size() == recording.diameter.size());
        for (const Contact& contact : scan.contacts)
            good = good && is_grain(contact.grain) &&
                   (is_grain(contact.partner) ||
                    (contact.partner < 0 && contact.partner >= wall_partner(Wall::plate)));
        if (!good)
            throw py::value_error(fmt::format("scan {}: numbers of grains, walls or phases", scan.frame));
    }
}

Measurement measurement_of(const std::map<std::string, double>& values) {
    return {values.at("position_error"), values.at("diameter_error"), values.at("force_error"),
            values.at("force_threshold")};
}

Experiment experiment_of(const py::dict& fields) {
    Experiment experiment;
    experiment.name = fields["name"].cast<std::string>();
    Recording& recording = experiment.recording;
    recording.label = experiment.name;
    recording.parameters = parameters_of(fields["parameters"].cast<ParameterTexts>());
    const auto size = fields["size"].cast<std::pair<double, double>>();
    recording.box = {size.first, size.second, *parse<ContainerShape>(fields["shape"].cast<std::string>())};
    recording.plate_start = fields["plate_start"].cast<double>();
    recording.diameter = fields["diameter"].cast<std::vector<double>>();
    recording.scans = scans_of(fields);
    expect_consistent(recording);
    experiment.materials = fields["materials"].cast<std::map<std::string, double>>();
    experiment.uncertainty = fields["uncertainty"].cast<std::map<std::string, double>>();
    experiment.measurement = measurement_of(fields["measurement"].cast<std::map<std::string, double>>());
    experiment.plate_speed = fields["plate_speed"].cast<std::optional<double>>();
    experiment.plate_pause = fields["plate_pause"].cast<double>();
    experiment.plate_hold = fields["plate_hold"].cast<double>();
    return experiment;
}

Instrument instrument_of(const std::map<std::string, double>& values) {
    Instrument instrument;
    instrument.stated = measurement_of(values);
    for (const auto& [name, member] : {std::pair{"force_bias", &Instrument::force_bias},
                                       {"threshold_shift", &Instrument::threshold_shift},
                                       {"position_bias", &Instrument::position_bias},
                                       {"strain_offset", &Instrument::strain_offset},
                                       {"gauge_drift", &Instrument::gauge_drift},
                                       {"zero_drift", &Instrument::zero_drift},
                                       {"gauge_hysteresis", &Instrument::gauge_hysteresis},
                                       {"force_lag", &Instrument::force_lag},
                                       {"guide_friction", &Instrument::guide_friction},
                                       {"force_saturation", &Instrument::force_saturation}})
        if (const auto found = values.find(name); found != values.end()) instrument.*member = found->second;
    return instrument;
}

}  // namespace

void bind_experiment(py::module_& module) {
    py::class_<Experiment>(module, "Experiment", "A measured compression.")
        .def(py::init(&experiment_of), py::arg("fields"));
    module.def(
        "compared_forces",
        [](const Experiment& experiment) {
            const ComparedForces forces = compared_forces(experiment.recording);
            return py::make_tuple(forces.displacement, forces.known, min_bins);
        },
        py::arg("experiment"),
        "Displacements [m] at which a diagnosis compares forces while loading and unloading, the number of "
        "known "
        "forces, and the number needed.");
    module.def(
        "measured",
        [](const SharedRun& run, const std::map<std::string, double>& instrument, std::uint64_t seed) {
            const Instrument read_by = instrument_of(instrument);
            const py::gil_scoped_release others_go_on;
            return std::make_shared<Run>(
                Run{run->name, "", "", "", "", {measured(run->recordings.at(0), read_by, seed)}});
        },
        py::arg("run"), py::arg("instrument"), py::arg("seed"),
        "The first recording of a run as an instrument reads it (experiment/instrument.h).");
}

}  // namespace mcdem::python
