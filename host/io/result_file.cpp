#include "io/result_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/container.h"
#include "core/errors.h"
#include "scene/read/keys.h"

namespace mcdem::inline io {
namespace {

bool is_length(double value) { return std::isfinite(value) && value > 0; }

}  // namespace

ResultFile::ResultFile(const std::filesystem::path& file) : file_(h5::File::open(file)) {
    if (!file_.has_attribute("/parameters", "format"))
        throw InputError(file.string() +
                         ": is HDF5 but not a result of this program: give a run.h5 or the "
                         "folder of a run");
    const long format = file_.integer_attribute("/parameters", "format");
    if (format < 1 || format > result_format)
        throw InputError(fmt::format("{}: has layout {}, this program reads up to {}: use a newer version",
                                     file.string(), format, result_format));
    is_double_ = file_.text_attribute("/parameters", "precision") == name(Precision::double_precision);
}

Run ResultFile::header() const {
    Run run;
    run.name = file_.text_attribute("/parameters", "name");
    run.program = file_.text_attribute("/parameters", "program");
    run.device = file_.text_attribute("/parameters", "device");
    run.precision = file_.text_attribute("/parameters", "precision");
    const auto scene = file_.read_texts("/parameters/scene");
    if (!scene.empty()) run.scene = scene.front();
    const long replicas = file_.integer_attribute("/parameters", "replicas");
    if (replicas != static_cast<long>(file_.members("/observables").size()))
        throw InputError(file_.where("/observables") + ": must hold " + std::to_string(replicas) +
                         " replicas");
    for (long r = 0; r < replicas; ++r)
        run.recordings.push_back(recording_header(static_cast<std::size_t>(r)));
    return run;
}

/// Files of runs without species have none.
void ResultFile::read_species(Recording& recording, const std::string& particles) const {
    if (!file_.exists(particles + "/species")) return;
    const auto species = file_.dataset(particles + "/species");
    species.expect_row({});
    recording.species = species.read_all<int>();
    recording.species_names = file_.read_texts(particles + "/species_names");
    const auto count = static_cast<int>(recording.species_names.size());
    const bool known =
        std::ranges::all_of(recording.species, [&](int one) { return one >= 0 && one < count; });
    if (!known || recording.species.size() != recording.diameter.size())
        throw InputError(fmt::format("{}: must be a species of 0 to {} for each of the {} grains",
                                     species.where(), count - 1, recording.diameter.size()));
}

Recording ResultFile::recording_header(std::size_t replica) const {
    const std::string particles = particles_path(replica);
    Recording recording;
    recording.label = file_.text_attribute(particles, "label");
    const auto edges = file_.numbers_attribute(particles + "/box", "edges");
    if (edges.size() != 3 || !std::ranges::all_of(edges, is_length))
        throw InputError(file_.where(particles + "/box") + ": edges must be 3 numbers > 0 [m]");
    recording.box = {edges[0], edges[1]};
    if (file_.has_attribute(particles + "/box", "shape")) {
        const auto shape = parse<ContainerShape>(file_.text_attribute(particles + "/box", "shape"));
        if (!shape)
            throw InputError(file_.where(particles + "/box") + ": shape must be one of " +
                             all_names<ContainerShape>());
        recording.box.shape = *shape;
    }
    recording.plate_start = edges[2];
    if (is_cell(recording.box)) recording.box.height = edges[2];
    const auto diameter = file_.dataset(particles + "/diameter");
    diameter.expect_row({});
    recording.diameter = diameter.read_all<double>();
    if (const auto bad = std::ranges::find_if_not(recording.diameter, is_length);
        bad != recording.diameter.end())
        throw InputError(fmt::format("{}: must be numbers > 0 [m], got {} for grain {}", diameter.where(),
                                     *bad, bad - recording.diameter.begin()));
    read_species(recording, particles);
    const auto parameters = file_.read_texts(parameters_path(replica));
    if (parameters.size() % 2 != 0)
        throw InputError(file_.where(parameters_path(replica)) + ": must be pairs");
    ParameterTexts texts;
    for (std::size_t i = 0; i < parameters.size(); i += 2) texts[parameters[i]] = parameters[i + 1];
    recording.parameters = parameters_of(texts);
    if (file_.has_attribute(particles, "failure_cause"))
        recording.failure = Failure{file_.integer_attribute(particles, "failure_step"),
                                    static_cast<int>(file_.integer_attribute(particles, "failure_grain")),
                                    file_.text_attribute(particles, "failure_cause")};
    return recording;
}

std::vector<Scan> ResultFile::scans(const Recording& recording, std::size_t replica, ReadWhat what) const {
    const h5::Dataset table = file_.dataset(observables_path(replica));
    const h5::Handle type = scan_row_type();
    table.expect_row({});
    expect_fields(table, type,
                  {"rate_error", "max_overlap", "stress", "fabric", "strain", "wall_work", "weight_work",
                   "damping_loss", "friction_loss", "drag_loss",
                   "energy_error"});  // files of earlier versions have none
    std::vector<ScanRow> rows(table.rows(), scan_row(Scan{}));
    table.read(type, rows.data(), 0, rows.size());
    std::vector<Scan> scans;
    scans.reserve(rows.size());
    for (const ScanRow& row : rows) scans.push_back(scan_of(row, table.where()));
    const Window all{scans, 0, true};
    const std::size_t grains = recording.diameter.size();
    if (what == ReadWhat::positions || what == ReadWhat::everything) {
        read_vectors(all, &Scan::position, grains, particles_path(replica) + "/position");
        read_vectors(all, &Scan::rotation, grains, particles_path(replica) + "/rotation");
    }
    if (what == ReadWhat::contacts || what == ReadWhat::everything) read_contacts(all, grains, replica);
    return scans;
}

namespace {

/// Row `row` of a table with one vector per grain.
std::vector<Vec3> vectors_in(const h5::Dataset& table, std::size_t row, std::size_t grains) {
    std::vector<Vec3> vectors(grains);
    table.read(h5::number_type<double>(), vectors.data()->data(), row, 1);
    for (std::size_t i = 0; i < grains; ++i)
        if (!vectors[i].allFinite())
            throw InputError(fmt::format("{}: grain {} has a value that is no number", table.where(), i));
    return vectors;
}

template <class Real>
std::vector<Contact> read_contact_rows(const h5::Dataset& table, std::size_t grains, long first, long last) {
    const h5::Handle type = contact_row_type<Real>();
    std::vector<ContactRow<Real>> rows(static_cast<std::size_t>(last - first));
    table.read(type, rows.data(), static_cast<hsize_t>(first), rows.size());
    std::vector<Contact> contacts;
    contacts.reserve(rows.size());
    for (const auto& row : rows) contacts.push_back(contact_of(row, grains, table.where()));
    return contacts;
}

}  // namespace

void ResultFile::read_vectors(const Window& window, std::vector<Vec3> Scan::*vectors, std::size_t grains,
                              const std::string& group) const {
    // Files of earlier versions have no rotations.
    if (grains == 0 || (group.ends_with("/rotation") && !file_.exists(group))) return;
    const h5::Dataset table = file_.dataset(group + "/value");
    table.expect_row({grains, 3});
    const auto step = file_.dataset(group + "/step").read_all<long>();
    if (step.size() != table.rows()) throw InputError(table.where() + ": must have one row for each of step");
    const auto scans = static_cast<long>(window.scans.size());
    for (std::size_t k = 0; k < step.size(); ++k) {
        const long scan = step[k] - window.first;
        if (scan >= 0 && scan < scans)
            window.scans[scan].*vectors = vectors_in(table, k, grains);
        else if (window.all)
            throw InputError(fmt::format("{}: step {} must be the row of a scan, 0 to {}", table.where(),
                                         step[k], scans - 1));
    }
}

std::vector<Contact> ResultFile::contact_rows(const h5::Dataset& table, std::size_t grains, long first,
                                              long last) const {
    return is_double_ ? read_contact_rows<double>(table, grains, first, last)
                      : read_contact_rows<float>(table, grains, first, last);
}

void ResultFile::read_contacts(const Window& window, std::size_t grains, std::size_t replica) const {
    const h5::Dataset table = file_.dataset(contacts_path(replica) + "/contact");
    const h5::Dataset offsets = file_.dataset(contacts_path(replica) + "/offset");
    table.expect_row({});
    offsets.expect_row({});
    expect_fields(table, contact_row_type<double>());
    std::vector<long> offset(window.scans.size() + 1);
    const auto contacts = static_cast<long>(table.rows());
    bool good = !window.all || offsets.rows() == offset.size();
    if (good)
        offsets.read(h5::number_type<long>(), offset.data(), static_cast<hsize_t>(window.first),
                     offset.size());
    good = good && std::ranges::is_sorted(offset) && offset.front() >= 0 && offset.back() <= contacts;
    if (!good || (window.all && (offset.front() != 0 || offset.back() != contacts)))
        throw InputError(table.where() +
                         ": offset must rise from 0 to the number of contacts, one entry a scan "
                         "and one more");
    // One scan at a time, because the rows of a whole replica would double the memory.
    for (std::size_t s = 0; s < window.scans.size(); ++s)
        window.scans[s].contacts = contact_rows(table, grains, offset[s], offset[s + 1]);
}

void ResultFile::fill(Scan& scan, std::size_t grains, std::size_t replica, std::size_t row) const {
    const Window one{{&scan, 1}, static_cast<long>(row), false};
    read_contacts(one, grains, replica);
    read_vectors(one, &Scan::position, grains, particles_path(replica) + "/position");
    read_vectors(one, &Scan::rotation, grains, particles_path(replica) + "/rotation");
}

}  // namespace mcdem::io
