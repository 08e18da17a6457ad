// One result file: written scan by scan, read whole or scan by scan. The layout lives here and in
// result_rows.h; README.md describes it.
#pragma once
#include <functional>
#include <optional>

#include "core/recording.h"
#include "io/hdf5.h"
#include "io/result_rows.h"
#include "io/results.h"

namespace mcdem::inline io {

/// Where the tables of one replica are, e.g. "/observables/replica_00003".
std::string observables_path(std::size_t replica);
std::string particles_path(std::size_t replica);
std::string contacts_path(std::size_t replica);
std::string parameters_path(std::size_t replica);

/// Number of this layout; readers refuse a later one.
inline constexpr long result_format = 1;

/// Writes replica by replica, scan by scan. The bytes depend on the content alone, not on how the scans
/// came: an interrupted run ends with the same file as one that was not.
class ResultWriter {
public:
    /// Starts a file with the provenance and the recordings of `run`, as yet without scans.
    ResultWriter(NewFile& out, const Run& run);
    void append(std::size_t replica, Scan scan);
    /// The last scan of this replica was appended; why it stopped early, if it did.
    void end(std::size_t replica, const std::optional<Failure>& failure);
    void close();

private:
    struct Tables {
        h5::Dataset scans, contacts, contact_offset;
        std::vector<h5::Dataset> position, rotation;  ///< value, step, time; none where there are no grains
        std::size_t grains = 0;
        std::string label;
        long contact_count = 0;
    };
    void write_provenance(const Run& run);
    Tables make_tables(std::size_t replica, const Recording& recording);
    void flush(Tables& tables);
    void flush_scans(Tables& tables);
    /// Of positions or rotations: value, step and time, an element of H5MD.
    std::vector<h5::Dataset> make_vectors(const std::string& group, const char* unit, std::size_t grains);
    template <class Real>
    void flush_vectors(std::vector<h5::Dataset>& tables, std::vector<Vec3> Scan::*vectors, long first_row);
    template <class Real>
    void flush_contacts(Tables& tables);

    h5::File file_;
    std::vector<Tables> tables_;
    std::vector<Scan> pending_;  ///< written together, in blocks of the same number whatever the source
    h5::Handle scan_row_, contact_row_;
    bool is_double_;  ///< positions and contacts are kept as double, else as float
};

/// Writes a result file with what `write` appends, reads all of it back, and puts it into place.
void write_result_file(const std::filesystem::path& file, const Run& run,
                       const std::function<void(ResultWriter&)>& write);

class ResultFile {
public:
    explicit ResultFile(const std::filesystem::path& file);
    /// Provenance and recordings, without scans.
    Run header() const;
    std::vector<Scan> scans(const Recording& recording, std::size_t replica, ReadWhat what) const;
    /// Fills in positions, rotations and contacts of the scan in row `row`.
    void fill(Scan& scan, std::size_t grains, std::size_t replica, std::size_t row) const;
    /// False in files of programs that kept none.
    bool has_digests() const { return !file_.digests().empty(); }
    /// Reads all tables. Throws InputError that names the first one whose digest does not match.
    void expect_whole() const;
    /// Positions and contacts of one replica alone.
    void expect_whole(std::size_t replica) const;

private:
    Recording recording_header(std::size_t replica) const;
    void read_species(Recording& recording, const std::string& particles) const;
    /// Positions or rotations, from an element of H5MD.
    void read_vectors(std::vector<Scan>& scans, std::vector<Vec3> Scan::*vectors, std::size_t grains,
                      const std::string& group) const;
    /// .. at one scan; empty where there are none.
    std::vector<Vec3> vectors_at(std::size_t row, std::size_t grains, const std::string& group) const;
    bool has_vectors(std::size_t grains, const std::string& group) const;
    void read_contacts(std::vector<Scan>& scans, std::size_t grains, std::size_t replica) const;
    std::vector<Contact> contact_rows(const h5::Dataset& table, std::size_t grains, long first,
                                      long last) const;
    h5::File file_;
    bool is_double_ = false;
};

/// Provenance and recordings, without scans, of a run that lies in several files one after the other.
Run read_run_header(const std::vector<std::filesystem::path>& files);

}  // namespace mcdem::io
