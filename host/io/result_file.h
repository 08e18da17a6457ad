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

/// Writes replica after replica. The bytes depend only on the content: an interrupted and resumed run gives
/// the same file as an uninterrupted one.
class ResultWriter {
public:
    /// Starts a file with the provenance of `run`. `between` is called between replicas and their scans; what
    /// it throws is passed on.
    ResultWriter(
        NewFile& out, const Run& run, h5::Storage storage = h5::Storage::compressed,
        std::function<void()> between = [] {});
    /// Starts the next replica, with the properties of `recording`.
    void begin(const Recording& recording);
    /// Adds the next scans of the replica.
    void append(const StoredScans& scans);
    /// Ends the replica; `failure` says why it stopped early, if it did.
    void end(const std::optional<Failure>& failure);
    void close();

private:
    /// Positions or rotations.
    struct Vectors {
        h5::NewTable value;
        std::vector<long> step{};
        std::vector<double> time{};
    };
    /// Of the current replica.
    struct Tables {
        h5::NewTable scans, contacts;
        Vectors position, rotation;
        std::size_t grains;
        std::vector<long> contact_offset{0};
    };
    void write_provenance(const Run& run);
    void write_properties(const Recording& recording);
    void close_vectors(const std::string& group, const char* unit, Vectors& vectors);

    h5::File file_;
    h5::Storage storage_;
    std::function<void()> between_;
    std::size_t replica_ = 0;  ///< the current one
    std::optional<Tables> tables_;
    bool is_double_;  ///< positions and contacts are stored as double, otherwise as float
};

/// Writes a result file with the content from `write` and moves it into place. Throws Interrupted, and leaves
/// no file, if `stop_wanted` becomes true meanwhile.
void write_result_file(const std::filesystem::path& file, const Run& run, h5::Storage storage,
                       const std::function<void(ResultWriter&)>& write,
                       const StopWanted& stop_wanted = never_stop);
/// Writes the header of a run with these scans of its replicas.
void write_run(const std::filesystem::path& file, const Run& header, const std::vector<StoredScans>& scans,
               h5::Storage storage);
/// An empty one for each replica.
std::vector<StoredScans> stored_scans(const Run& header);

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
