#include "io/result_rows.h"

#include <algorithm>
#include <cstring>

#include "core/errors.h"

namespace mcdem::inline io {
namespace {

h5::Handle array_type(hid_t element, std::vector<hsize_t> extent) {
    return {H5Tarray_create2(element, static_cast<unsigned>(extent.size()), extent.data()), H5Tclose};
}

/// With the names that h5py uses, so it shows the field as numpy.bool_.
h5::Handle truth_type() {
    h5::Handle type(H5Tenum_create(H5T_NATIVE_SCHAR), H5Tclose);
    const signed char no = 0, yes = 1;
    H5Tenum_insert(type, "FALSE", &no);
    H5Tenum_insert(type, "TRUE", &yes);
    return type;
}

h5::Handle phase_type() {
    h5::Handle type(H5Tenum_create(H5T_NATIVE_SCHAR), H5Tclose);
    for (signed char i = 0; i < static_cast<signed char>(Names<Phase>::list.size()); ++i)
        H5Tenum_insert(type, std::string(Names<Phase>::list[static_cast<std::size_t>(i)]).c_str(), &i);
    return type;
}

template <class Real>
void copy(const Vec3& from, Real* to) {
    for (int k = 0; k < 3; ++k) to[k] = static_cast<Real>(from[k]);
}
template <class Real>
Vec3 vec3(const Real* from) {
    return {from[0], from[1], from[2]};
}

}  // namespace

ScanRow scan_row(const Scan& scan) {
    ScanRow row{};
    row.frame = scan.frame;
    row.cycle = scan.cycle;
    row.phase = static_cast<signed char>(scan.phase);
    row.settled = scan.settled;
    row.time = scan.time;
    row.plate_z = scan.plate_z;
    for (int wall = 0; wall < wall_count; ++wall) copy(scan.wall_force[wall], row.wall_force[wall]);
    row.kinetic_energy = scan.kinetic_energy;
    row.elastic_energy = scan.elastic_energy;
    row.rate_error = scan.rate_error;
    row.coordination_number = scan.coordination_number;
    row.mean_force = scan.mean_force;
    row.packing_fraction = scan.packing_fraction;
    row.branch_length = scan.branch_length;
    row.max_overlap = scan.max_overlap;
    std::memcpy(row.stress, scan.stress.data(), sizeof row.stress);
    std::memcpy(row.fabric, scan.fabric.data(), sizeof row.fabric);
    std::ranges::copy(scan.strain, row.strain);
    return row;
}

Scan scan_of(const ScanRow& row, const std::string& where) {
    if (row.phase < 0 || row.phase >= static_cast<int>(Names<Phase>::list.size()))
        throw InputError(where + ": phase must be load or unload, got number " + std::to_string(row.phase));
    Scan scan;
    scan.frame = row.frame;
    scan.cycle = row.cycle;
    scan.phase = static_cast<Phase>(row.phase);
    scan.settled = row.settled != 0;
    scan.time = row.time;
    scan.plate_z = row.plate_z;
    for (int wall = 0; wall < wall_count; ++wall) scan.wall_force[wall] = vec3(row.wall_force[wall]);
    scan.kinetic_energy = row.kinetic_energy;
    scan.elastic_energy = row.elastic_energy;
    scan.rate_error = row.rate_error;
    scan.coordination_number = row.coordination_number;
    scan.mean_force = row.mean_force;
    scan.packing_fraction = row.packing_fraction;
    scan.branch_length = row.branch_length;
    scan.max_overlap = row.max_overlap;
    std::memcpy(scan.stress.data(), row.stress, sizeof row.stress);
    std::memcpy(scan.fabric.data(), row.fabric, sizeof row.fabric);
    std::ranges::copy(row.strain, scan.strain.begin());
    return scan;
}

template <class Real>
ContactRow<Real> contact_row(const Contact& contact) {
    ContactRow<Real> row{};
    row.grain = contact.grain;
    row.partner = contact.partner;
    copy(contact.point, row.point);
    copy(contact.force, row.force);
    row.overlap = static_cast<Real>(contact.overlap);
    return row;
}
template ContactRow<float> contact_row(const Contact&);
template ContactRow<double> contact_row(const Contact&);

template <class Real>
Contact contact_of(const ContactRow<Real>& row, std::size_t grains, const std::string& where) {
    const int count = static_cast<int>(grains);
    if (row.grain < 0 || row.grain >= count || row.partner >= count || row.partner < -wall_count)
        throw InputError(where + ": there is a contact of grain " + std::to_string(row.grain) +
                         " with partner " + std::to_string(row.partner) + ", but the grains are 0 to " +
                         std::to_string(count - 1) + " and the walls -1 to " + std::to_string(-wall_count));
    const Contact contact{row.grain, row.partner, vec3(row.point), vec3(row.force), row.overlap};
    if (!contact.point.allFinite() || !contact.force.allFinite())
        throw InputError(where + ": there is a contact of grain " + std::to_string(row.grain) +
                         " whose point or force is no number");
    return contact;
}
template Contact contact_of(const ContactRow<float>&, std::size_t, const std::string&);
template Contact contact_of(const ContactRow<double>&, std::size_t, const std::string&);

h5::Handle scan_row_type() {
    h5::Handle type(H5Tcreate(H5T_COMPOUND, sizeof(ScanRow)), H5Tclose);
    H5Tinsert(type, "frame", HOFFSET(ScanRow, frame), H5T_NATIVE_INT);
    H5Tinsert(type, "cycle", HOFFSET(ScanRow, cycle), H5T_NATIVE_INT);
    H5Tinsert(type, "phase", HOFFSET(ScanRow, phase), phase_type());
    H5Tinsert(type, "settled", HOFFSET(ScanRow, settled), truth_type());
    H5Tinsert(type, "time", HOFFSET(ScanRow, time), H5T_NATIVE_DOUBLE);
    H5Tinsert(type, "plate_z", HOFFSET(ScanRow, plate_z), H5T_NATIVE_DOUBLE);
    H5Tinsert(type, "wall_force", HOFFSET(ScanRow, wall_force),
              array_type(H5T_NATIVE_DOUBLE, {wall_count, 3}));
    H5Tinsert(type, "kinetic_energy", HOFFSET(ScanRow, kinetic_energy), H5T_NATIVE_DOUBLE);
    H5Tinsert(type, "elastic_energy", HOFFSET(ScanRow, elastic_energy), H5T_NATIVE_DOUBLE);
    H5Tinsert(type, "rate_error", HOFFSET(ScanRow, rate_error), H5T_NATIVE_DOUBLE);
    H5Tinsert(type, "coordination_number", HOFFSET(ScanRow, coordination_number), H5T_NATIVE_DOUBLE);
    H5Tinsert(type, "mean_force", HOFFSET(ScanRow, mean_force), H5T_NATIVE_DOUBLE);
    H5Tinsert(type, "packing_fraction", HOFFSET(ScanRow, packing_fraction), H5T_NATIVE_DOUBLE);
    H5Tinsert(type, "branch_length", HOFFSET(ScanRow, branch_length), H5T_NATIVE_DOUBLE);
    H5Tinsert(type, "max_overlap", HOFFSET(ScanRow, max_overlap), H5T_NATIVE_DOUBLE);
    const h5::Handle tensor = array_type(H5T_NATIVE_DOUBLE, {3, 3});
    H5Tinsert(type, "stress", HOFFSET(ScanRow, stress), tensor);
    H5Tinsert(type, "fabric", HOFFSET(ScanRow, fabric), tensor);
    H5Tinsert(type, "strain", HOFFSET(ScanRow, strain), array_type(H5T_NATIVE_DOUBLE, {6}));
    return type;
}

template <class Real>
h5::Handle contact_row_type() {
    using Row = ContactRow<Real>;
    h5::Handle type(H5Tcreate(H5T_COMPOUND, sizeof(Row)), H5Tclose);
    const h5::Handle real = h5::number_type<Real>(), triple = array_type(real, {3});
    H5Tinsert(type, "grain", HOFFSET(Row, grain), H5T_NATIVE_INT);
    H5Tinsert(type, "partner", HOFFSET(Row, partner), H5T_NATIVE_INT);
    H5Tinsert(type, "point", HOFFSET(Row, point), triple);
    H5Tinsert(type, "force", HOFFSET(Row, force), triple);
    H5Tinsert(type, "overlap", HOFFSET(Row, overlap), real);
    return type;
}
template h5::Handle contact_row_type<float>();
template h5::Handle contact_row_type<double>();

h5::Handle packed(const h5::Handle& row_type) {
    h5::Handle type(H5Tcopy(row_type), H5Tclose);
    H5Tpack(type);
    return type;
}

void expect_fields(const h5::Dataset& table, const h5::Handle& row_type,
                   std::initializer_list<std::string_view> optional) {
    const h5::Handle found = table.type();
    if (H5Tget_class(found) != H5T_COMPOUND) table.fail("must be a table of named fields");
    for (int i = 0; i < H5Tget_nmembers(row_type); ++i) {
        char* field = H5Tget_member_name(row_type, static_cast<unsigned>(i));
        const std::string name = field ? field : "";
        H5free_memory(field);
        if (std::ranges::find(optional, name) == optional.end() &&
            H5Tget_member_index(found, name.c_str()) < 0)
            table.fail("must have a field '" + name + "'");
    }
}

std::vector<std::pair<std::string, std::string>> scan_row_units() {
    return {{"time", "s"},
            {"plate_z", "m"},
            {"wall_force", "N"},
            {"kinetic_energy", "J"},
            {"elastic_energy", "J"},
            {"rate_error", "1"},
            {"coordination_number", "1"},
            {"mean_force", "N"},
            {"packing_fraction", "1"},
            {"branch_length", "m"},
            {"max_overlap", "1"},
            {"stress", "Pa"},
            {"fabric", "1"},
            {"strain", "1"}};
}

std::vector<std::pair<std::string, std::string>> contact_row_units() {
    return {{"point", "m"}, {"force", "N"}, {"overlap", "m"}};
}

}  // namespace mcdem::io
