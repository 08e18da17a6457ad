// Result files: written scan by scan, read completely or scan by scan. This file and result_rows.h define the
// layout; README.md describes it.
#pragma once
#include <functional>
#include <optional>
#include <span>

#include "core/recording.h"
#include "core/stop.h"
#include "io/hdf5.h"
#include "io/result_rows.h"
#include "io/results.h"

namespace mcdem::inline io {

/// Path of the tables of one replica, e.g. "/observables/replica_00003".
std::string observables_path(std::size_t replica);
std::string particles_path(std::size_t replica);
std::string contacts_path(std::size_t replica);
std::string parameters_path(std::size_t replica);

/// Version of this layout; readers refuse later ones.
inline constexpr long result_format = 1;

/// Writes replica by replica, scan by scan. The bytes depend only on the content, not on the order of the
/// calls: an interrupted and resumed run gives the same file as an uninterrupted one.
class ResultWriter {
public:
    /// Starts a file with the provenance and the recordings of `run`, still without scans. `between` is
    /// called between tables and scans; what it throws is passed on.
    ResultWriter(
        NewFile& out, const Run& run, std::function<void()> between = [] {});
    void append(std::size_t replica, Scan scan);
    /// Call after the last scan of a replica; `failure` says why it stopped early, if it did.
    void end(std::size_t replica, const std::optional<Failure>& failure);
    void close();

private:
    struct Tables {
        h5::Dataset scans, contacts, contact_offset;
        std::vector<h5::Dataset> position, rotation;  ///< value, step, time; none if there are no grains
        std::size_t grains = 0;
        std::string label;
        long contact_count = 0;
    };
    void write_provenance(const Run& run);
    Tables make_tables(std::size_t replica, const Recording& recording);
    void flush(Tables& tables);
    void flush_scans(Tables& tables);
    /// For positions or rotations: value, step and time, an element of H5MD.
    std::vector<h5::Dataset> make_vectors(const std::string& group, const char* unit, std::size_t grains);
    template <class Real>
    void flush_vectors(std::vector<h5::Dataset>& tables, std::vector<Vec3> Scan::*vectors, long first_row);
    template <class Real>
    void flush_contacts(Tables& tables);

    h5::File file_;
    std::function<void()> between_;
    std::vector<Tables> tables_;
    std::vector<Scan> pending_;  ///< written together, in blocks whose size does not depend on the source
    h5::Handle scan_row_, contact_row_;
    bool is_double_;  ///< positions and contacts are stored as double, otherwise as float
};

/// Writes a result file with the content from `write`, reads all of it back, and moves it into place. Throws
/// Interrupted, and leaves no file, if `stop_wanted` becomes true meanwhile.
void write_result_file(const std::filesystem::path& file, const Run& run,
                       const std::function<void(ResultWriter&)>& write,
                       const StopWanted& stop_wanted = never_stop);

class ResultFile {
public:
    explicit ResultFile(const std::filesystem::path& file);
    /// Provenance and recordings, without scans.
    Run header() const;
    std::vector<Scan> scans(const Recording& recording, std::size_t replica, ReadWhat what) const;
    /// Fills in positions, rotations and contacts of the scan in row `row`.
    void fill(Scan& scan, std::size_t grains, std::size_t replica, std::size_t row) const;
    /// Reads all tables. Throws InputError with the name of the first one with a wrong checksum.
    void expect_whole(const std::function<void()>& before_each = [] {}) const {
        file_.expect_whole(before_each);
    }

private:
    /// Scans to read: those in the rows from `first` on, and whether these are all.
    struct Window {
        std::span<Scan> scans;
        long first;
        bool all;
    };
    Recording recording_header(std::size_t replica) const;
    void read_species(Recording& recording, const std::string& particles) const;
    /// Positions or rotations, from an element of H5MD.
    void read_vectors(const Window& window, std::vector<Vec3> Scan::*vectors, std::size_t grains,
                      const std::string& group) const;
    void read_contacts(const Window& window, std::size_t grains, std::size_t replica) const;
    std::vector<Contact> contact_rows(const h5::Dataset& table, std::size_t grains, long first,
                                      long last) const;
    h5::File file_;
    bool is_double_ = false;
};

/// The files of one run. They stay open if there are not too many, because a run that ends in the meantime
/// removes them.
class ResultFiles {
public:
    explicit ResultFiles(std::vector<std::filesystem::path> paths)
        : paths_(std::move(paths)), open_(paths_.size()) {}
    const std::vector<std::filesystem::path>& paths() const { return paths_; }
    const ResultFile& open(std::size_t index);

private:
    std::vector<std::filesystem::path> paths_;
    std::vector<std::optional<ResultFile>> open_;
};

/// Provenance and recordings, without scans, of a run in several consecutive files.
Run read_run_header(const std::vector<std::filesystem::path>& files);

}  // namespace mcdem::io
