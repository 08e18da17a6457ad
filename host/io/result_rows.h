// Rows of the tables in a result file, and the offsets of their fields in memory.
#pragma once
#include "core/recording.h"
#include "io/hdf5.h"

namespace mcdem::inline io {

/// One scan without positions and contacts.
struct ScanRow {
    int frame, cycle;
    signed char phase, settled;
    double time, plate_z;
    double wall_force[wall_count][3];
    double kinetic_energy, elastic_energy, rate_error;
    double wall_work, weight_work, damping_loss, friction_loss, drag_loss, energy_error;
    double coordination_number, mean_force, packing_fraction, branch_length, max_overlap;
    double stress[3][3], fabric[3][3];
    double strain[6];
};

/// Real is the type in the file, float or double: rows are read and written without conversion. It has no
/// gaps.
template <class Real>
struct ContactRow {
    int grain, partner;
    Real point[3], force[3], overlap;
};

ScanRow scan_row(const Scan& scan);
/// Throws InputError with `where` if the row contains impossible values.
Scan scan_of(const ScanRow& row, const std::string& where);
template <class Real>
Contact contact_of(const ContactRow<Real>& row, std::size_t grains, const std::string& where);

/// Scans of one replica as the bytes of the tables' rows.
class StoredScans {
public:
    StoredScans(std::size_t grains, bool is_double) : grains_(grains), is_double_(is_double) {}
    /// Throws RunError if positions or rotations are not those of all grains.
    void append(const Scan& scan);
    /// Keeps the memory.
    void clear();
    std::size_t count() const { return contact_count.size(); }
    std::size_t bytes() const { return contacts.size() + position.value.size() + rotation.value.size(); }

    /// Positions or rotations: an element of H5MD.
    struct Vectors {
        std::vector<std::byte> value;
        std::vector<long> step;  ///< number of the scan, from 0
        std::vector<double> time;
    };
    std::vector<std::byte> scans, contacts;
    std::vector<long> contact_count;  ///< of each scan
    Vectors position, rotation;

private:
    template <class Real>
    void append_as(const Scan& scan);
    template <class Real>
    void append_vectors(const Scan& scan, const std::vector<Vec3>& vectors, Vectors& to);
    std::size_t grains_;
    bool is_double_;
};

/// The fields of the rows as one HDF5 type, at the offsets of the struct.
h5::Handle scan_row_type();
template <class Real>
h5::Handle contact_row_type();
/// The same fields as stored in the file, without gaps.
h5::Handle packed(const h5::Handle& row_type);
/// Throws unless the table has every field of `row_type` except the optional ones. Missing fields of a row
/// keep their values.
void expect_fields(const h5::Dataset& table, const h5::Handle& row_type,
                   std::initializer_list<std::string_view> optional = {});

/// Field names and their units, for the attributes of the tables.
std::vector<std::pair<std::string, std::string>> scan_row_units();
std::vector<std::pair<std::string, std::string>> contact_row_units();

}  // namespace mcdem::io
