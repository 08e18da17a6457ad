#include "io/hdf5.h"

#include <algorithm>
#include <cstring>
#include <new>

#include "core/errors.h"

namespace mcdem::h5 {
namespace {

constexpr hsize_t chunk_bytes = 32 * 1024;
constexpr unsigned deflate_level = 1;  // a higher one costs five times the time for a few per cent
// Deflate packs at most 1032:1. A table that claims more than its file can hold is damaged, and is not
// worth the memory.
constexpr double most_bytes_per_byte = 1100;
constexpr double small_table = 1 << 20;

/// Told before anything else: no cleaning up at exit. Every file is closed by its owner; one whose disk was
/// full stays half closed, and the library crashes when it tries again.
[[maybe_unused]] const herr_t no_cleaning_up = H5dont_atexit();

/// The library prints its own error stacks unless told not to; ours carry the reason.
void silence_library() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

std::string library_reason() {
    std::string reason;
    const auto keep_first = [](unsigned, const H5E_error2_t* error, void* text) -> herr_t {
        auto& reason = *static_cast<std::string*>(text);
        if (reason.empty() && error->desc) reason = error->desc;
        return 0;
    };
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, &reason);
    // Where the system refused, its own words are enough: ".., error message = 'No space left on device', .."
    const std::string before_words = "error message = '";
    const auto words = reason.find(before_words);
    if (words == std::string::npos) return reason;
    const auto begin = words + before_words.size();
    return reason.substr(begin, reason.find('\'', begin) - begin);
}

Handle checked(hid_t id, Handle::Close close, Access access, const std::string& where, const char* what) {
    if (id < 0) fail(access, where, what);
    return {id, close};
}

Handle file_access() {
    Handle properties(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    // The 1.10 format: its metadata carry checksums, so that damage is noticed.
    H5Pset_libver_bounds(properties, H5F_LIBVER_V110, H5F_LIBVER_V110);
    H5Pset_fclose_degree(properties, H5F_CLOSE_STRONG);
    // Files are put into place whole, so nobody reads a file being written; network disks often lack locks.
    H5Pset_file_locking(properties, false, true);
    return properties;
}

/// The library clears its conversion buffer, 1 MiB unless told otherwise, on every call: for a few rows
/// that is most of the time.
Handle transfer(const Extent& size, hid_t memory_type) {
    hsize_t bytes = H5Tget_size(memory_type);
    for (hsize_t n : size) bytes *= n;
    Handle properties(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
    H5Pset_buffer(properties, std::clamp<hsize_t>(bytes, 1024, 1024 * 1024), nullptr, nullptr);
    return properties;
}

/// Properties of a new object that keeps no time of day: the same run gives the same bytes.
Handle without_times(hid_t object_class) {
    Handle properties(H5Pcreate(object_class), H5Pclose);
    H5Pset_obj_track_times(properties, false);
    return properties;
}

}  // namespace

template <>
Handle number_type<double>() {
    return {H5Tcopy(H5T_NATIVE_DOUBLE), H5Tclose};
}
template <>
Handle number_type<float>() {
    return {H5Tcopy(H5T_NATIVE_FLOAT), H5Tclose};
}
template <>
Handle number_type<int>() {
    return {H5Tcopy(H5T_NATIVE_INT), H5Tclose};
}
template <>
Handle number_type<long>() {
    return {H5Tcopy(H5T_NATIVE_LONG), H5Tclose};
}
template <>
Handle number_type<unsigned char>() {
    return {H5Tcopy(H5T_NATIVE_UCHAR), H5Tclose};
}

Handle text_type(std::size_t length) {
    Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, std::max<std::size_t>(length, 1));
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    H5Tset_cset(type, H5T_CSET_UTF8);
    return type;
}

void fail(Access access, const std::string& where, const std::string& what) {
    const std::string reason = library_reason();
    std::string message = where + ": " + what + (reason.empty() ? "" : " (" + reason + ")");
    if (access == Access::write) throw RunError(message);
    throw InputError(message +
                     "; the file is damaged or was not written by this program: restore it from a "
                     "copy or run again");
}

Extent Dataset::extent() const {
    const Handle space = checked(H5Dget_space(id_), H5Sclose, access_, where_, "has no extent");
    const int rank = H5Sget_simple_extent_ndims(space);
    if (rank < 1) fail(access_, where_, "must be a table of rows");
    Extent extent(static_cast<std::size_t>(rank));
    H5Sget_simple_extent_dims(space, extent.data(), nullptr);
    return extent;
}

Handle Dataset::type() const { return checked(H5Dget_type(id_), H5Tclose, access_, where_, "has no type"); }

Handle Dataset::select(hsize_t first, hsize_t rows) const {
    Extent start = extent(), count = start;
    std::fill(start.begin(), start.end(), 0);
    start.front() = first;
    count.front() = rows;
    Handle space = checked(H5Dget_space(id_), H5Sclose, access_, where_, "has no extent");
    if (H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) < 0)
        fail(access_, where_, "has no such rows");
    return space;
}

void Dataset::append(hid_t memory_type, const void* data, hsize_t rows) {
    if (rows == 0) return;
    Extent size = extent();
    const hsize_t first = size.front();
    size.front() += rows;
    if (H5Dset_extent(id_, size.data()) < 0) fail(access_, where_, "cannot grow");
    size.front() = rows;
    const Handle memory(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose);
    const Handle file = select(first, rows);
    if (H5Dwrite(id_, memory_type, memory, file, transfer(size, memory_type), data) < 0)
        fail(access_, where_, "cannot be written");
}

void Dataset::read(hid_t memory_type, void* data, hsize_t first, hsize_t rows) const {
    if (rows == 0) return;
    Extent size = extent();
    if (first + rows > size.front()) fail(access_, where_, "ends early");
    size.front() = rows;
    const Handle memory(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose);
    const Handle file = select(first, rows);
    if (H5Dread(id_, memory_type, memory, file, transfer(size, memory_type), data) < 0)
        fail(access_, where_, "cannot be read");
}

void Dataset::expect_row(const Extent& row) const {
    const Extent found = extent();
    if (!std::equal(found.begin() + 1, found.end(), row.begin(), row.end())) {
        H5Eclear2(H5E_DEFAULT);
        fail(access_, where_, "has rows of another size than expected");
    }
}

File File::create(const std::filesystem::path& file) {
    silence_library();
    const Handle properties = file_access();
    return {checked(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, without_times(H5P_FILE_CREATE), properties),
                    H5Fclose, Access::write, file.string(), "cannot be created"),
            Access::write, file};
}

File File::open(const std::filesystem::path& file) {
    silence_library();
    if (!std::filesystem::is_regular_file(file)) throw InputError(file.string() + ": no such file");
    const Handle properties = file_access();
    return {checked(H5Fopen(file.c_str(), H5F_ACC_RDONLY, properties), H5Fclose, Access::read, file.string(),
                    "cannot be opened as HDF5"),
            Access::read, file};
}

void File::close() {
    if (access_ == Access::write && H5Fflush(id_, H5F_SCOPE_LOCAL) < 0)
        fail(access_, path_.string(), "cannot be written");
    if (H5Fclose(id_.release()) < 0) fail(access_, path_.string(), "cannot be closed");
}

void File::make_group(const std::string& object) {
    const Handle layout = without_times(H5P_GROUP_CREATE);
    for (std::size_t end = 0; end != std::string::npos;) {
        end = object.find('/', end + 1);
        const std::string group = object.substr(0, end);
        if (!exists(group))
            checked(H5Gcreate2(id_, group.c_str(), H5P_DEFAULT, layout, H5P_DEFAULT), H5Gclose, access_,
                    where(group), "cannot be created");
    }
}

bool File::exists(const std::string& object) const {
    // H5Lexists wants every group on the way to exist.
    for (std::size_t end = object.find('/', 1); end != std::string::npos; end = object.find('/', end + 1))
        if (H5Lexists(id_, object.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
    return H5Lexists(id_, object.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> File::members(const std::string& group) const {
    std::vector<std::string> names;
    const auto keep_name = [](hid_t, const char* name, const H5L_info_t*, void* names) -> herr_t {
        static_cast<std::vector<std::string>*>(names)->emplace_back(name);
        return 0;
    };
    const Handle handle = object(group);
    if (H5Literate(handle, H5_INDEX_NAME, H5_ITER_INC, nullptr, keep_name, &names) < 0)
        fail(access_, where(group), "cannot be listed");
    return names;
}

Dataset File::create_rows(const std::string& object, hid_t file_type, const Extent& row, Storage storage,
                          hsize_t rows_expected) {
    Extent now{0}, most{H5S_UNLIMITED}, chunk{1};
    hsize_t bytes = std::max<hsize_t>(H5Tget_size(file_type), 1);
    for (hsize_t n : row) {
        now.push_back(n);
        most.push_back(n);
        chunk.push_back(n);
        bytes *= n;
    }
    const hsize_t wanted = storage == Storage::plain ? 1024 * 1024 : chunk_bytes;
    chunk.front() = std::max<hsize_t>(wanted / bytes, 1);
    if (rows_expected > 0) chunk.front() = std::min(chunk.front(), rows_expected);
    const Handle space(H5Screate_simple(static_cast<int>(now.size()), now.data(), most.data()), H5Sclose);
    if (const auto group = object.rfind('/'); group > 0) make_group(object.substr(0, group));
    const Handle layout = without_times(H5P_DATASET_CREATE);
    H5Pset_chunk(layout, static_cast<int>(chunk.size()), chunk.data());
    if (storage == Storage::compressed) {
        H5Pset_shuffle(layout);
        H5Pset_deflate(layout, deflate_level);
    }
    H5Pset_fletcher32(layout);
    return {checked(H5Dcreate2(id_, object.c_str(), file_type, space, H5P_DEFAULT, layout, H5P_DEFAULT),
                    H5Dclose, access_, where(object), "cannot be created"),
            access_, where(object)};
}

Dataset File::dataset(const std::string& object) const {
    Dataset found(checked(H5Dopen2(id_, object.c_str(), H5P_DEFAULT), H5Dclose, access_, where(object),
                          "cannot be found"),
                  access_, where(object));
    double bytes = static_cast<double>(H5Tget_size(found.type()));
    for (hsize_t n : found.extent()) bytes *= static_cast<double>(n);
    if (bytes > small_table + most_bytes_per_byte * static_cast<double>(std::filesystem::file_size(path_)))
        fail(access_, where(object), "claims to hold more than the file can");
    return found;
}

}  // namespace mcdem::h5
