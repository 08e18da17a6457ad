#include "fuzz/mutate_hdf5.h"

#include <cstring>
#include <string>
#include <vector>

#include "io/hdf5.h"

namespace mcdem::fuzz {
namespace {

using h5::Handle;

std::vector<std::string> names_in(hid_t file) {
    std::vector<std::string> names;
    H5Lvisit(
        file, H5_INDEX_NAME, H5_ITER_INC,
        [](hid_t, const char* name, const H5L_info_t*, void* all) -> herr_t {
            static_cast<std::vector<std::string>*>(all)->emplace_back(name);
            return 0;
        },
        &names);
    return names;
}

Handle open_object(hid_t file, const std::string& name) {
    return {H5Oopen(file, name.c_str(), H5P_DEFAULT), H5Oclose};
}

Handle some_type(ByteSource& source) {
    const hid_t types[] = {H5T_NATIVE_INT8,  H5T_NATIVE_INT,   H5T_NATIVE_LONG,
                           H5T_NATIVE_ULONG, H5T_NATIVE_FLOAT, H5T_NATIVE_DOUBLE};
    const std::size_t which = source.below(9);
    if (which < 6) return {H5Tcopy(types[which]), H5Tclose};
    Handle text(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(text, which == 6 ? H5T_VARIABLE : 1 + source.below(40));
    if (which < 8) return text;
    Handle row(H5Tcreate(H5T_COMPOUND, 16), H5Tclose);
    H5Tinsert(row, "frame", 0, H5T_NATIVE_DOUBLE);
    H5Tinsert(row, "force", 8, H5T_NATIVE_LONG);
    return row;
}

/// Small, or too large to be allocated.
hsize_t some_extent(hsize_t before, ByteSource& source) {
    switch (source.below(8)) {
        case 0:
            return 0;
        case 1:
            return 1;
        case 2:
            return before + 1;
        case 3:
            return before > 0 ? before - 1 : 0;
        case 4:
            return source.below(50);
        case 5:
            return hsize_t{1} << 46;
        default:
            return before;
    }
}

std::vector<hsize_t> extent_of(hid_t set) {
    const Handle space(H5Dget_space(set), H5Sclose);
    std::vector<hsize_t> extent(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
    if (!extent.empty()) H5Sget_simple_extent_dims(space, extent.data(), nullptr);
    return extent;
}

/// Overwrites a few positions of the values with extreme numbers.
void change_values(hid_t set, ByteSource& source) {
    const Handle type(H5Dget_type(set), H5Tclose), space(H5Dget_space(set), H5Sclose);
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    const std::size_t bytes = H5Tget_size(type) * static_cast<std::size_t>(std::max<hssize_t>(count, 0));
    if (bytes == 0 || bytes > 1 << 20 || H5Tis_variable_str(type) > 0) return;
    std::vector<char> values(bytes);
    if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) return;
    for (int change = 0; change <= source.byte() % 3; ++change) {
        const std::size_t width = source.byte() % 2 ? 8 : 4;
        if (bytes < width) return;
        char* at = &values[source.below(bytes / width) * width];
        const double real = source.number();
        const auto single = static_cast<float>(real);
        const std::int64_t whole = source.integer();
        if (source.byte() % 2)
            std::memcpy(at, width == 8 ? static_cast<const void*>(&real) : &single, width);
        else
            std::memcpy(at, &whole, width);
    }
    H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

void make_anew(hid_t file, const std::string& name, ByteSource& source) {
    std::vector<hsize_t> extent{1};
    {
        const Handle old = open_object(file, name);
        if (old >= 0 && H5Iget_type(old) == H5I_DATASET) extent = extent_of(old);
    }
    for (hsize_t& n : extent) n = some_extent(n, source);
    if (source.byte() % 4 == 0) extent.push_back(1 + source.below(4));
    if (source.byte() % 4 == 0 && !extent.empty()) extent.pop_back();
    const Handle type = some_type(source), list(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    const Handle space(extent.empty()
                           ? H5Screate(H5S_SCALAR)
                           : H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr),
                       H5Sclose);
    if (!extent.empty()) {
        const std::vector<hsize_t> chunk(extent.size(), 8);
        H5Pset_chunk(list, static_cast<int>(chunk.size()), chunk.data());
    }
    H5Ldelete(file, name.c_str(), H5P_DEFAULT);
    const Handle made(H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, list, H5P_DEFAULT), H5Dclose);
    if (made >= 0) change_values(made, source);
}

void grow(hid_t set, ByteSource& source) {
    auto extent = extent_of(set);
    if (extent.empty()) return;
    extent.front() = some_extent(extent.front(), source);
    H5Dset_extent(set, extent.data());
}

void change_attribute(hid_t object, ByteSource& source) {
    const auto count = static_cast<hsize_t>(std::max(0, H5Aget_num_attrs(object)));
    if (count == 0) return;
    char name[64] = "";
    const hsize_t which = source.below(count);
    H5Aget_name_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC, which, name, sizeof name, H5P_DEFAULT);
    H5Adelete(object, name);
    if (source.byte() % 4 == 0) return;
    const hsize_t length = source.below(4);
    const Handle space(source.byte() % 2 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &length, nullptr),
                       H5Sclose);
    const bool real = source.byte() % 2;
    const Handle type = source.byte() % 3 == 0
                            ? some_type(source)
                            : Handle(H5Tcopy(real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_LONG), H5Tclose);
    const Handle made(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (made < 0 || H5Tget_class(type) == H5T_STRING || H5Tget_class(type) == H5T_COMPOUND) return;
    const double reals[] = {source.number(), source.number(), source.number()};
    const long wholes[] = {source.integer(), source.integer(), source.integer()};
    H5Awrite(made, real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_LONG,
             real ? static_cast<const void*>(reals) : wholes);
}

void relink(hid_t file, const std::string& name, const std::string& other, ByteSource& source) {
    H5Ldelete(file, name.c_str(), H5P_DEFAULT);
    switch (source.below(5)) {
        case 0:
            return;
        case 1:
            H5Lcreate_soft(("/" + other).c_str(), file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
            return;
        case 2:
            H5Lcreate_hard(file, other.c_str(), file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
            return;
        case 3:
            H5Lcreate_external("/dev/null", "/", file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
            return;
        default:
            H5Gclose(H5Gcreate2(file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    }
}

void mutate_once(hid_t file, ByteSource& source) {
    const auto names = names_in(file);
    if (names.empty()) return;
    const std::string& name = names[source.below(names.size())];
    const std::size_t what = source.below(8);
    if (what == 0) return relink(file, name, names[source.below(names.size())], source);
    if (what == 1) return make_anew(file, name, source);
    const Handle object = open_object(file, name);
    if (object < 0) return;
    const bool is_table = H5Iget_type(object) == H5I_DATASET;
    if (what <= 3 || !is_table)
        change_attribute(object, source);
    else if (what == 4)
        grow(object, source);
    else
        change_values(object, source);
}

}  // namespace

void mutate_hdf5(const std::filesystem::path& path, ByteSource& source) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    for (int change = 0; change < 4 && !source.empty(); ++change) mutate_once(file, source);
}

}  // namespace mcdem::fuzz
