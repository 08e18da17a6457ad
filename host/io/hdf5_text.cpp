// Texts and attributes of HDF5 files.
#include <algorithm>

#include "io/hdf5.h"

namespace mcdem::inline io::h5 {
namespace {

/// Attributes are small; a larger one indicates damage.
constexpr hssize_t max_numbers = 1000;
constexpr std::size_t max_text_size = 1 << 20;

Handle scalar() { return {H5Screate(H5S_SCALAR), H5Sclose}; }

std::string without_padding(const char* text, std::size_t size) {
    return {text, static_cast<std::size_t>(std::find(text, text + size, '\0') - text)};
}

bool is_fixed_text(hid_t type) { return H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0; }

/// The same text type in memory: the library converts padding but not character sets.
Handle memory_text(hid_t file_type) {
    Handle type = text_type(H5Tget_size(file_type));
    H5Tset_cset(type, H5Tget_cset(file_type));
    return type;
}

}  // namespace

Handle File::object(const std::string& object) const {
    expect_inside(object);
    const hid_t id = H5Oopen(id_, object.c_str(), H5P_DEFAULT);
    if (id < 0) fail(where(object), "cannot be found");
    return {id, H5Oclose};
}

Handle File::attribute(const std::string& object, const std::string& name) const {
    expect_inside(object);
    const hid_t id = H5Aopen_by_name(id_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    if (id < 0) fail(where(object), "attribute '" + name + "' cannot be found");
    return {id, H5Aclose};
}

void File::write_attribute(const std::string& object, const std::string& name, hid_t type, hid_t space,
                           const void* data) {
    Handle owner(H5Oopen(id_, object.c_str(), H5P_DEFAULT), H5Oclose);
    Handle attribute(H5Acreate2(owner, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (attribute < 0 || H5Awrite(attribute, type, data) < 0)
        fail(where(object), "attribute '" + name + "' cannot be written");
    close_written(std::move(attribute), object);
    close_written(std::move(owner), object);
}

void File::set_attribute(const std::string& object, const std::string& name, std::string_view text) {
    std::string padded(text);
    padded.resize(std::max<std::size_t>(text.size(), 1));
    const Handle type = text_type(text.size());
    // Some readers know only ASCII.
    if (std::ranges::all_of(text, [](unsigned char c) { return c < 128; })) H5Tset_cset(type, H5T_CSET_ASCII);
    write_attribute(object, name, type, scalar(), padded.data());
}

void File::set_attribute(const std::string& object, const std::string& name,
                         const std::vector<double>& values) {
    const hsize_t count = values.size();
    const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
    write_attribute(object, name, number_type<double>(), space, values.data());
}

void File::set_attribute(const std::string& object, const std::string& name,
                         const std::vector<long>& values) {
    const hsize_t count = values.size();
    const Handle space = count == 1 ? scalar() : Handle(H5Screate_simple(1, &count, nullptr), H5Sclose);
    write_attribute(object, name, number_type<long>(), space, values.data());
}

bool File::has_attribute(const std::string& object, const std::string& name) const {
    expect_inside(object);
    return answered(H5Aexists_by_name(id_, object.c_str(), name.c_str(), H5P_DEFAULT), object) > 0;
}

std::string File::text_attribute(const std::string& object, const std::string& name) const {
    const Handle found = attribute(object, name);
    const Handle type(H5Aget_type(found), H5Tclose), space(H5Aget_space(found), H5Sclose);
    const std::size_t size = H5Tget_size(type);
    if (!is_fixed_text(type) || H5Sget_simple_extent_npoints(space) != 1 || size > max_text_size)
        fail(where(object), "attribute '" + name + "' must be a text");
    std::string text(size, '\0');
    if (H5Aread(found, memory_text(type), text.data()) < 0)
        fail(where(object), "attribute '" + name + "' cannot be read");
    return without_padding(text.data(), text.size());
}

std::vector<double> File::numbers_attribute(const std::string& object, const std::string& name) const {
    const Handle found = attribute(object, name);
    const Handle space(H5Aget_space(found), H5Sclose);
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    if (count < 0 || count > max_numbers) fail(where(object), "attribute '" + name + "' is too long");
    std::vector<double> values(static_cast<std::size_t>(count));
    if (count > 0 && H5Aread(found, number_type<double>(), values.data()) < 0)
        fail(where(object), "attribute '" + name + "' must hold numbers");
    return values;
}

long File::integer_attribute(const std::string& object, const std::string& name) const {
    const Handle found = attribute(object, name);
    const Handle type(H5Aget_type(found), H5Tclose), space(H5Aget_space(found), H5Sclose);
    long value = 0;
    if (H5Tget_class(type) != H5T_INTEGER || H5Sget_simple_extent_npoints(space) != 1 ||
        H5Aread(found, number_type<long>(), &value) < 0)
        fail(where(object), "attribute '" + name + "' must be an integer");
    return value;
}

void File::write_texts(const std::string& object, const std::vector<std::string>& texts, const Extent& row) {
    std::size_t length = 1;
    for (const auto& text : texts) length = std::max(length, text.size());
    std::string padded;
    padded.reserve(length * texts.size());
    for (const auto& text : texts) padded += text + std::string(length - text.size(), '\0');
    NewTable table(*this, object, text_type(length), row);
    table.append(padded.data(), texts.size() / values_in(row));
    table.close();
}

std::vector<std::string> File::read_texts(const std::string& object) const {
    const Dataset table = dataset(object);
    const Handle type = table.type();
    if (!is_fixed_text(type)) fail(where(object), "must hold texts of fixed length");
    const hsize_t count = values_in(table.extent());
    const std::size_t length = H5Tget_size(type);
    std::string padded(count * length, '\0');
    table.read(memory_text(type), padded.data(), 0, table.rows());
    std::vector<std::string> texts;
    for (hsize_t i = 0; i < count; ++i) texts.push_back(without_padding(padded.data() + i * length, length));
    return texts;
}

}  // namespace mcdem::io::h5
