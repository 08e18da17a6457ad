#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/container.h"
#include "core/errors.h"
#include "io/result_file.h"

namespace mcdem::inline io {
namespace {

bool is_double(const Run& run) { return run.precision == name(Precision::double_precision); }

}  // namespace

std::string observables_path(std::size_t replica) {
    return fmt::format("/observables/replica_{:05}", replica);
}
std::string particles_path(std::size_t replica) { return fmt::format("/particles/replica_{:05}", replica); }
std::string contacts_path(std::size_t replica) { return fmt::format("/contacts/replica_{:05}", replica); }
std::string parameters_path(std::size_t replica) { return fmt::format("/parameters/replica_{:05}", replica); }

ResultWriter::ResultWriter(NewFile& out, const Run& run, h5::Storage storage, std::function<void()> between)
    : file_(h5::File::create(out)),
      storage_(storage),
      between_(std::move(between)),
      is_double_(is_double(run)) {
    write_provenance(run);
}

void ResultWriter::write_provenance(const Run& run) {
    for (const char* group :
         {"/h5md/author", "/h5md/creator", "/parameters", "/particles", "/observables", "/contacts"})
        file_.make_group(group);
    file_.set_attribute("/h5md", "version", std::vector<long>{1, 1});
    file_.set_attribute("/h5md/author", "name", std::string_view("unknown"));
    file_.set_attribute("/h5md/creator", "name", std::string_view("mcdem"));
    file_.set_attribute("/h5md/creator", "version", run.program);
    file_.set_attribute("/parameters", "format", std::vector<long>{result_format});
    file_.set_attribute("/parameters", "replicas",
                        std::vector<long>{static_cast<long>(run.recordings.size())});
    file_.set_attribute("/parameters", "name", run.name);
    file_.set_attribute("/parameters", "program", run.program);
    file_.set_attribute("/parameters", "device", run.device);
    file_.set_attribute("/parameters", "precision", run.precision);
    file_.write_texts("/parameters/scene", {run.scene});
    // Once for all replicas: an attribute takes more time than the row of a scan.
    for (const auto& [field, unit] : scan_row_units())
        file_.set_attribute("/observables", "unit " + field, unit);
    for (const auto& [field, unit] : contact_row_units())
        file_.set_attribute("/contacts", "unit " + field, unit);
}

void ResultWriter::write_properties(const Recording& recording) {
    const std::string particles = particles_path(replica_);
    std::vector<std::string> parameters;
    for (const auto& [key, value] : recording.parameters)
        parameters.insert(parameters.end(), {key, parameter_text(value)});
    file_.write_texts(parameters_path(replica_), parameters, {2});

    file_.make_group(particles + "/box");
    file_.set_attribute(particles, "label", recording.label);
    file_.set_attribute(particles + "/box", "dimension", std::vector<long>{3});
    file_.set_attribute(particles + "/box", "boundary",
                        std::string_view(is_cell(recording.box)       ? "periodic periodic periodic"
                                         : is_periodic(recording.box) ? "periodic periodic none"
                                                                      : "none"));
    file_.set_attribute(particles + "/box", "shape", name(recording.box.shape));
    file_.set_attribute(
        particles + "/box", "edges",
        std::vector<double>{recording.box.size_x, recording.box.size_y, recording.plate_start});
    file_.write(particles + "/diameter", recording.diameter);
    file_.set_attribute(particles + "/diameter", "unit", std::string_view("m"));
    if (recording.species_names.empty()) return;
    file_.write(particles + "/species", recording.species);
    file_.write_texts(particles + "/species_names", recording.species_names);
}

void ResultWriter::begin(const Recording& recording) {
    between_();
    write_properties(recording);
    const std::string particles = particles_path(replica_), contacts = contacts_path(replica_);
    const auto table = [&](const std::string& object, h5::Handle type, h5::Extent row) {
        return h5::NewTable(file_, object, std::move(type), std::move(row), storage_);
    };
    const auto real = [&] { return is_double_ ? h5::number_type<double>() : h5::number_type<float>(); };
    const h5::Extent vectors{recording.diameter.size(), 3};
    tables_ = Tables{
        table(observables_path(replica_), packed(scan_row_type()), {}),
        table(contacts + "/contact", is_double_ ? contact_row_type<double>() : contact_row_type<float>(), {}),
        {table(particles + "/position/value", real(), vectors)},
        {table(particles + "/rotation/value", real(), vectors)},
        recording.diameter.size()};
}

/// Scan by scan, so that the order of the chunks in the file does not depend on the calls.
void ResultWriter::append(const StoredScans& scans) {
    between_();
    Tables& to = *tables_;
    const auto first = static_cast<long>(to.contact_offset.size()) - 1;
    const std::byte *row = scans.scans.data(), *contact = scans.contacts.data();
    const auto vectors = [&](const StoredScans::Vectors& from, Vectors& to) {
        return [&, next = std::size_t{0}, at = from.value.data()](long scan) mutable {
            if (next == from.step.size() || from.step[next] != scan) return;
            at = to.value.append(at, 1);
            to.step.push_back(first + scan);
            to.time.push_back(from.time[next++]);
        };
    };
    auto position = vectors(scans.position, to.position), rotation = vectors(scans.rotation, to.rotation);
    for (long scan = 0; scan < static_cast<long>(scans.count()); ++scan) {
        row = to.scans.append(row, 1);
        position(scan), rotation(scan);
        const long count = scans.contact_count[static_cast<std::size_t>(scan)];
        contact = to.contacts.append(contact, static_cast<hsize_t>(count));
        to.contact_offset.push_back(to.contact_offset.back() + count);
    }
}

/// An element of H5MD.
void ResultWriter::close_vectors(const std::string& group, const char* unit, Vectors& vectors) {
    vectors.value.close();
    file_.write(group + "/step", vectors.step);
    file_.write(group + "/time", vectors.time);
    file_.set_attribute(group + "/value", "unit", std::string_view(unit));
    file_.set_attribute(group + "/time", "unit", std::string_view("s"));
}

void ResultWriter::end(const std::optional<Failure>& failure) {
    between_();
    const std::string particles = particles_path(replica_);
    Tables& tables = *tables_;
    for (auto* table : {&tables.scans, &tables.contacts, &tables.position.value, &tables.rotation.value})
        table->finish();
    tables.scans.close();
    tables.contacts.close();
    file_.write(contacts_path(replica_) + "/offset", tables.contact_offset);
    if (tables.grains > 0) {
        close_vectors(particles + "/position", "m", tables.position);
        close_vectors(particles + "/rotation", "rad", tables.rotation);
    }
    if (failure) {
        file_.set_attribute(particles, "failure_cause", failure->cause);
        file_.set_attribute(particles, "failure_step", std::vector<long>{failure->step});
        file_.set_attribute(particles, "failure_grain", std::vector<long>{failure->grain});
    }
    tables_.reset();
    ++replica_;
}

void ResultWriter::close() { file_.close(); }

void write_result_file(const std::filesystem::path& file, const Run& run, h5::Storage storage,
                       const std::function<void(ResultWriter&)>& write, const StopWanted& stop_wanted) {
    const auto check_stop = [&] {
        if (stop_wanted()) throw Interrupted();
    };
    check_stop();
    replace_file(file, [&](NewFile& out) {
        ResultWriter writer(out, run, storage, check_stop);
        write(writer);
        writer.close();
        out.close();
    });
}

std::vector<StoredScans> stored_scans(const Run& header) {
    std::vector<StoredScans> scans;
    for (const Recording& recording : header.recordings)
        scans.emplace_back(recording.diameter.size(), is_double(header));
    return scans;
}

void write_run(const std::filesystem::path& file, const Run& header, const std::vector<StoredScans>& scans,
               h5::Storage storage) {
    write_result_file(file, header, storage, [&](ResultWriter& writer) {
        for (std::size_t r = 0; r < header.recordings.size(); ++r) {
            writer.begin(header.recordings[r]);
            writer.append(scans[r]);
            writer.end(header.recordings[r].failure);
        }
    });
}

void write_run(const std::filesystem::path& file, const Run& run) {
    auto scans = stored_scans(run);
    for (std::size_t r = 0; r < run.recordings.size(); ++r)
        for (const Scan& scan : run.recordings[r].scans) scans[r].append(scan);
    write_run(file, run, scans, h5::Storage::compressed);
}

}  // namespace mcdem::io
