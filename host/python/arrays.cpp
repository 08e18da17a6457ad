#include "python/arrays.h"

#include <algorithm>

#include "core/stress.h"

namespace mcdem::inline python {
namespace {

namespace py = pybind11;
static_assert(sizeof(Vec3) == 3 * sizeof(double), "positions are read as rows of three numbers");

/// An array of `count` contiguous objects: rows of named fields.
template <class Row>
class Fields {
public:
    template <class Member>
    Fields& add(const char* name, const Member Row::*member, const char* format) {
        const Row row{};
        names_.append(name);
        formats_.append(format);
        offsets_.append(reinterpret_cast<const char*>(&(row.*member)) - reinterpret_cast<const char*>(&row));
        return *this;
    }
    py::dtype type() const { return py::dtype(names_, formats_, offsets_, sizeof(Row)); }

private:
    py::list names_, formats_, offsets_;
};

py::array view(const py::dtype& type, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides,
               const void* data, py::handle owner) {
    py::array array(type, std::move(shape), std::move(strides), data, owner);
    array.attr("setflags")(py::arg("write") = false);
    return array;
}

template <class Row>
py::array rows(const std::vector<Row>& list, const py::dtype& type, py::handle owner) {
    return view(type, {static_cast<py::ssize_t>(list.size())}, {sizeof(Row)}, list.data(), owner);
}

py::dtype scan_type() {
    return Fields<Scan>()
        .add("frame", &Scan::frame, "i4")
        .add("cycle", &Scan::cycle, "i4")
        .add("phase", &Scan::phase, "i4")
        .add("settled", &Scan::settled, "?")
        .add("time", &Scan::time, "f8")
        .add("plate_z", &Scan::plate_z, "f8")
        .add("kinetic_energy", &Scan::kinetic_energy, "f8")
        .add("elastic_energy", &Scan::elastic_energy, "f8")
        .add("rate_error", &Scan::rate_error, "f8")
        .add("coordination_number", &Scan::coordination_number, "f8")
        .add("mean_force", &Scan::mean_force, "f8")
        .add("packing_fraction", &Scan::packing_fraction, "f8")
        .add("branch_length", &Scan::branch_length, "f8")
        .add("max_overlap", &Scan::max_overlap, "f8")
        .type();
}

py::dtype contact_type() {
    return Fields<Contact>()
        .add("grain", &Contact::grain, "i4")
        .add("partner", &Contact::partner, "i4")
        .add("point", &Contact::point, "(3,)f8")
        .add("force", &Contact::force, "(3,)f8")
        .add("overlap", &Contact::overlap, "f8")
        .type();
}

}  // namespace

py::array scans_array(const Recording& recording, py::handle owner) {
    return rows(recording.scans, scan_type(), owner);
}

py::array wall_force_array(const Recording& recording, py::handle owner) {
    static_assert(sizeof(Scan::wall_force) == 6 * sizeof(Vec3));
    const auto count = static_cast<py::ssize_t>(recording.scans.size());
    const Vec3* first = count == 0 ? nullptr : recording.scans.front().wall_force.data();
    return view(py::dtype::of<double>(), {count, 6, 3}, {sizeof(Scan), sizeof(Vec3), sizeof(double)}, first,
                owner);
}

py::array top_force_array(const Recording& recording, py::handle owner) {
    const auto count = static_cast<py::ssize_t>(recording.scans.size());
    const double* first =
        count == 0 ? nullptr : &recording.scans.front().wall_force[static_cast<int>(Wall::plate)].z();
    return view(py::dtype::of<double>(), {count}, {sizeof(Scan)}, first, owner);
}

py::array tensor_array(const Recording& recording, Mat3 Scan::*tensor, py::handle owner) {
    static_assert(sizeof(Mat3) == 9 * sizeof(double));
    const auto count = static_cast<py::ssize_t>(recording.scans.size());
    const double* first = count == 0 ? nullptr : (recording.scans.front().*tensor).data();
    return view(py::dtype::of<double>(), {count, 3, 3}, {sizeof(Scan), 3 * sizeof(double), sizeof(double)},
                first, owner);
}

py::array strain_array(const Recording& recording, py::handle owner) {
    const auto count = static_cast<py::ssize_t>(recording.scans.size());
    const double* first = count == 0 ? nullptr : recording.scans.front().strain.data();
    return view(py::dtype::of<double>(), {count, 6}, {sizeof(Scan), sizeof(double)}, first, owner);
}

py::array species_array(const Recording& recording, py::handle owner) {
    return rows(recording.species, py::dtype::of<int>(), owner);
}

py::array diameter_array(const Recording& recording, py::handle owner) {
    return rows(recording.diameter, py::dtype::of<double>(), owner);
}

namespace {

py::array vector_array(const std::vector<Vec3>& vectors, py::handle owner) {
    return view(py::dtype::of<double>(), {static_cast<py::ssize_t>(vectors.size()), 3},
                {sizeof(Vec3), sizeof(double)}, vectors.data(), owner);
}

}  // namespace

py::array position_array(const Scan& scan, py::handle owner) { return vector_array(scan.position, owner); }

py::array rotation_array(const Scan& scan, py::handle owner) { return vector_array(scan.rotation, owner); }

py::array contact_array(const Scan& scan, py::handle owner) {
    return rows(scan.contacts, contact_type(), owner);
}

py::array grain_stress_array(const Recording& recording, const Scan& scan) {
    const auto stress = grain_stress(recording.box, recording.diameter, scan);
    py::array_t<double> array({static_cast<py::ssize_t>(stress.size()), py::ssize_t{3}, py::ssize_t{3}});
    for (std::size_t i = 0; i < stress.size(); ++i)
        std::copy_n(stress[i].data(), 9, array.mutable_data(static_cast<py::ssize_t>(i), 0, 0));
    return array;
}

}  // namespace mcdem::python
