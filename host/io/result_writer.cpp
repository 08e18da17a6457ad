#include <fmt/format.h>

#include <algorithm>

#include "core/atomic_file.h"
#include "core/container.h"
#include "core/errors.h"
#include "io/result_file.h"

namespace mcdem::inline io {
namespace {

constexpr std::size_t block_grains = 65536;  ///< grains times scans written at once

}  // namespace

std::string observables_path(std::size_t replica) {
    return fmt::format("/observables/replica_{:05}", replica);
}
std::string particles_path(std::size_t replica) { return fmt::format("/particles/replica_{:05}", replica); }
std::string contacts_path(std::size_t replica) { return fmt::format("/contacts/replica_{:05}", replica); }
std::string parameters_path(std::size_t replica) { return fmt::format("/parameters/replica_{:05}", replica); }

ResultWriter::ResultWriter(NewFile& out, const Run& run, std::function<void()> between)
    : file_(h5::File::create(out)),
      between_(std::move(between)),
      scan_row_(scan_row_type()),
      is_double_(run.precision == name(Precision::double_precision)) {
    contact_row_ = is_double_ ? contact_row_type<double>() : contact_row_type<float>();
    write_provenance(run);
    for (std::size_t r = 0; r < run.recordings.size(); ++r) {
        between_();
        tables_.push_back(make_tables(r, run.recordings[r]));
    }
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

ResultWriter::Tables ResultWriter::make_tables(std::size_t replica, const Recording& recording) {
    const std::string particles = particles_path(replica), contacts = contacts_path(replica);
    std::vector<std::string> parameters;
    for (const auto& [key, value] : recording.parameters)
        parameters.insert(parameters.end(), {key, parameter_text(value)});
    file_.write_texts(parameters_path(replica), parameters, {2});

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
    if (!recording.species_names.empty()) {
        file_.write(particles + "/species", recording.species);
        file_.write_texts(particles + "/species_names", recording.species_names);
    }

    const hsize_t grains = recording.diameter.size();
    Tables tables{file_.create_rows(observables_path(replica), packed(scan_row_), {}),
                  file_.create_rows(contacts + "/contact", packed(contact_row_), {}),
                  file_.create_rows(contacts + "/offset", h5::number_type<long>(), {}),
                  {},
                  {},
                  grains,
                  recording.label,
                  0};
    if (grains > 0) {
        tables.position = make_vectors(particles + "/position", "m", grains);
        tables.rotation = make_vectors(particles + "/rotation", "rad", grains);
    }
    const long none = 0;
    tables.contact_offset.append(h5::number_type<long>(), &none, 1);
    return tables;
}

std::vector<h5::Dataset> ResultWriter::make_vectors(const std::string& group, const char* unit,
                                                    std::size_t grains) {
    const h5::Handle real = is_double_ ? h5::number_type<double>() : h5::number_type<float>();
    std::vector<h5::Dataset> tables;
    tables.push_back(file_.create_rows(group + "/value", real, {grains, 3}));
    tables.push_back(file_.create_rows(group + "/step", h5::number_type<long>(), {}));
    tables.push_back(file_.create_rows(group + "/time", h5::number_type<double>(), {}));
    file_.set_attribute(group + "/value", "unit", std::string_view(unit));
    file_.set_attribute(group + "/time", "unit", std::string_view("s"));
    return tables;
}

void ResultWriter::append(std::size_t replica, Scan scan) {
    between_();
    Tables& tables = tables_.at(replica);
    for (const auto* vectors : {&scan.position, &scan.rotation})
        if (!vectors->empty() && vectors->size() != tables.grains)
            throw RunError(fmt::format("{}: '{}', frame {}: {} positions or rotations for {} grains",
                                       file_.path().string(), tables.label, scan.frame, vectors->size(),
                                       tables.grains));
    pending_.push_back(std::move(scan));
    if (pending_.size() >= std::clamp<std::size_t>(block_grains / (tables.grains + 1), 1, 256)) flush(tables);
}

void ResultWriter::end(std::size_t replica, const std::optional<Failure>& failure) {
    between_();
    flush(tables_.at(replica));
    if (!failure) return;
    const std::string particles = particles_path(replica);
    file_.set_attribute(particles, "failure_cause", failure->cause);
    file_.set_attribute(particles, "failure_step", std::vector<long>{failure->step});
    file_.set_attribute(particles, "failure_grain", std::vector<long>{failure->grain});
}

void ResultWriter::flush(Tables& tables) {
    const long first_row = static_cast<long>(tables.scans.rows());
    if (is_double_) {
        flush_vectors<double>(tables.position, &Scan::position, first_row);
        flush_vectors<double>(tables.rotation, &Scan::rotation, first_row);
        flush_contacts<double>(tables);
    } else {
        flush_vectors<float>(tables.position, &Scan::position, first_row);
        flush_vectors<float>(tables.rotation, &Scan::rotation, first_row);
        flush_contacts<float>(tables);
    }
    flush_scans(tables);
    pending_.clear();
}

void ResultWriter::flush_scans(Tables& tables) {
    std::vector<ScanRow> rows;
    for (const Scan& scan : pending_) rows.push_back(scan_row(scan));
    tables.scans.append(scan_row_, rows.data(), rows.size());
}

template <class Real>
void ResultWriter::flush_vectors(std::vector<h5::Dataset>& tables, std::vector<Vec3> Scan::*vectors,
                                 long first_row) {
    std::vector<Real> value;
    std::vector<double> time;
    std::vector<long> step;
    for (std::size_t s = 0; s < pending_.size(); ++s) {
        if ((pending_[s].*vectors).empty()) continue;
        for (const Vec3& x : pending_[s].*vectors)
            for (double coordinate : x) value.push_back(static_cast<Real>(coordinate));
        step.push_back(first_row + static_cast<long>(s));
        time.push_back(pending_[s].time);
    }
    if (step.empty()) return;
    tables[0].append(h5::number_type<Real>(), value.data(), step.size());
    tables[1].append(h5::number_type<long>(), step.data(), step.size());
    tables[2].append(h5::number_type<double>(), time.data(), time.size());
}

template <class Real>
void ResultWriter::flush_contacts(Tables& tables) {
    std::vector<ContactRow<Real>> rows;
    std::vector<long> offset;
    for (const Scan& scan : pending_) {
        for (const Contact& contact : scan.contacts) rows.push_back(contact_row<Real>(contact));
        offset.push_back(tables.contact_count + static_cast<long>(rows.size()));
    }
    tables.contact_count += static_cast<long>(rows.size());
    tables.contacts.append(contact_row_, rows.data(), rows.size());
    tables.contact_offset.append(h5::number_type<long>(), offset.data(), offset.size());
}

void ResultWriter::close() {
    for (Tables& tables : tables_) {
        between_();
        for (h5::Dataset* table : {&tables.scans, &tables.contacts, &tables.contact_offset}) table->close();
        for (auto* vectors : {&tables.position, &tables.rotation})
            for (h5::Dataset& table : *vectors) table.close();
    }
    file_.close();
}

void write_result_file(const std::filesystem::path& file, const Run& run,
                       const std::function<void(ResultWriter&)>& write, const StopWanted& stop_wanted) {
    const auto check_stop = [&] {
        if (stop_wanted()) throw Interrupted();
    };
    check_stop();
    replace_file(file, [&](NewFile& out) {
        ResultWriter writer(out, run, check_stop);
        write(writer);
        writer.close();
        out.close();
        try {
            ResultFile(out.temporary()).expect_whole(check_stop);
        } catch (const InputError& error) {
            throw RunError(fmt::format("{}: the file read back differs from the data written: {}",
                                       file.string(), error.what()));
        }
    });
}

void write_run(const std::filesystem::path& file, const Run& run) {
    const auto write = [&](ResultWriter& writer) {
        for (std::size_t r = 0; r < run.recordings.size(); ++r) {
            for (const Scan& scan : run.recordings[r].scans) writer.append(r, scan);
            writer.end(r, run.recordings[r].failure);
        }
    };
    write_result_file(file, run, write);
}

}  // namespace mcdem::io
