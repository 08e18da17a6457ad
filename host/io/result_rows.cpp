#include "io/result_rows.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <type_traits>

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
    for (signed char i = 0; i < static_cast<signed char>(name_list<Phase>.size()); ++i)
        H5Tenum_insert(type, std::string(name_list<Phase>[i]).c_str(), &i);
    return type;
}

/// Calls `visit` for every field of the rows of scans: name, unit, member of a scan and of a row.
void for_each_field(auto visit) {
    visit("frame", "", &Scan::frame, &ScanRow::frame);
    visit("cycle", "", &Scan::cycle, &ScanRow::cycle);
    visit("phase", "", &Scan::phase, &ScanRow::phase);
    visit("settled", "", &Scan::settled, &ScanRow::settled);
    visit("time", "s", &Scan::time, &ScanRow::time);
    visit("plate_z", "m", &Scan::plate_z, &ScanRow::plate_z);
    visit("wall_force", "N", &Scan::wall_force, &ScanRow::wall_force);
    visit("kinetic_energy", "J", &Scan::kinetic_energy, &ScanRow::kinetic_energy);
    visit("elastic_energy", "J", &Scan::elastic_energy, &ScanRow::elastic_energy);
    visit("wall_work", "J", &Scan::wall_work, &ScanRow::wall_work);
    visit("weight_work", "J", &Scan::weight_work, &ScanRow::weight_work);
    visit("damping_loss", "J", &Scan::damping_loss, &ScanRow::damping_loss);
    visit("friction_loss", "J", &Scan::friction_loss, &ScanRow::friction_loss);
    visit("drag_loss", "J", &Scan::drag_loss, &ScanRow::drag_loss);
    visit("energy_error", "J", &Scan::energy_error, &ScanRow::energy_error);
    visit("rate_error", "1", &Scan::rate_error, &ScanRow::rate_error);
    visit("coordination_number", "1", &Scan::coordination_number, &ScanRow::coordination_number);
    visit("mean_force", "N", &Scan::mean_force, &ScanRow::mean_force);
    visit("packing_fraction", "1", &Scan::packing_fraction, &ScanRow::packing_fraction);
    visit("branch_length", "m", &Scan::branch_length, &ScanRow::branch_length);
    visit("max_overlap", "1", &Scan::max_overlap, &ScanRow::max_overlap);
    visit("stress", "Pa", &Scan::stress, &ScanRow::stress);
    visit("fabric", "1", &Scan::fabric, &ScanRow::fabric);
    visit("strain", "1", &Scan::strain, &ScanRow::strain);
}

/// Converts a number; vectors and tensors have the same bytes in scans and rows.
template <class From, class To>
void convert(const From& from, To& to) {
    if constexpr (std::is_convertible_v<From, double> || std::is_enum_v<From> || std::is_enum_v<To>) {
        to = static_cast<To>(from);
    } else {
        static_assert(sizeof from == sizeof to);
        std::memcpy(static_cast<void*>(&to), &from, sizeof to);
    }
}

/// HDF5 type of a field.
template <class OfScan, class OfRow>
h5::Handle type_of() {
    if constexpr (std::is_same_v<OfScan, Phase>)
        return phase_type();
    else if constexpr (std::is_same_v<OfScan, bool>)
        return truth_type();
    else if constexpr (std::rank_v<OfRow> == 2)
        return array_type(H5T_NATIVE_DOUBLE, {std::extent_v<OfRow, 0>, std::extent_v<OfRow, 1>});
    else if constexpr (std::rank_v<OfRow> == 1)
        return array_type(H5T_NATIVE_DOUBLE, {std::extent_v<OfRow>});
    else
        return h5::number_type<OfRow>();
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

Scan scan_of(const ScanRow& row, const std::string& where) {
    if (row.phase < 0 || row.phase >= static_cast<int>(name_list<Phase>.size()))
        throw InputError(where + ": phase must be load or unload, got number " + std::to_string(row.phase));
    Scan scan;
    for_each_field([&](auto, auto, auto to, auto from) { convert(row.*from, scan.*to); });
    return scan;
}

ScanRow scan_row(const Scan& scan) {
    ScanRow row{};
    for_each_field([&](auto, auto, auto from, auto to) { convert(scan.*from, row.*to); });
    return row;
}

void StoredScans::append(const Scan& scan) {
    const ScanRow row = scan_row(scan);
    // The only gap of the struct is before `time`.
    constexpr std::size_t gap = offsetof(ScanRow, settled) + 1, behind = offsetof(ScanRow, time);
    const auto* const begin = reinterpret_cast<const std::byte*>(&row);
    scans.insert(scans.end(), begin, begin + gap);
    scans.insert(scans.end(), begin + behind, begin + sizeof row);
    is_double_ ? append_as<double>(scan) : append_as<float>(scan);
}

template <class Real>
void StoredScans::append_as(const Scan& scan) {
    append_vectors<Real>(scan, scan.position, position);
    append_vectors<Real>(scan, scan.rotation, rotation);
    const std::size_t size = contacts.size();
    contacts.resize(size + scan.contacts.size() * sizeof(ContactRow<Real>));
    auto* row = reinterpret_cast<ContactRow<Real>*>(contacts.data() + size);
    for (const Contact& contact : scan.contacts) {
        row->grain = contact.grain;
        row->partner = contact.partner;
        copy(contact.point, row->point);
        copy(contact.force, row->force);
        row++->overlap = static_cast<Real>(contact.overlap);
    }
    contact_count.push_back(static_cast<long>(scan.contacts.size()));
}

template <class Real>
void StoredScans::append_vectors(const Scan& scan, const std::vector<Vec3>& vectors, Vectors& to) {
    if (vectors.empty()) return;
    if (vectors.size() != grains_)
        throw RunError("frame " + std::to_string(scan.frame) + ": " + std::to_string(vectors.size()) +
                       " positions or rotations for " + std::to_string(grains_) + " grains");
    const std::size_t size = to.value.size();
    to.value.resize(size + vectors.size() * 3 * sizeof(Real));
    auto* at = reinterpret_cast<Real*>(to.value.data() + size);
    for (const Vec3& vector : vectors) copy(vector, at), at += 3;
    to.step.push_back(static_cast<long>(count()));
    to.time.push_back(scan.time);
}

void StoredScans::clear() {
    scans.clear(), contacts.clear(), contact_count.clear();
    for (Vectors* vectors : {&position, &rotation})
        vectors->value.clear(), vectors->step.clear(), vectors->time.clear();
}

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
    const Scan scan;
    const ScanRow row{};
    for_each_field([&](const char* name, auto, auto of_scan, auto of_row) {
        const auto offset =
            reinterpret_cast<const char*>(&(row.*of_row)) - reinterpret_cast<const char*>(&row);
        const auto field =
            type_of<std::decay_t<decltype(scan.*of_scan)>, std::remove_cvref_t<decltype(row.*of_row)>>();
        H5Tinsert(type, name, static_cast<std::size_t>(offset), field);
    });
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
    std::vector<std::pair<std::string, std::string>> units;
    for_each_field([&](const std::string& name, const std::string& unit, auto, auto) {
        if (!unit.empty()) units.emplace_back(name, unit);
    });
    return units;
}

std::vector<std::pair<std::string, std::string>> contact_row_units() {
    return {{"point", "m"}, {"force", "N"}, {"overlap", "m"}};
}

}  // namespace mcdem::io
