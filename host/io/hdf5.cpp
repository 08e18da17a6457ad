#include "io/hdf5.h"

#include <algorithm>
#include <system_error>

#include "core/errors.h"
#include "core/input_file.h"

namespace mcdem::inline io::h5 {
namespace {

// Deflate compresses at most 1032:1. A table that claims more than its file can contain is damaged, and no
// memory is allocated for it.
constexpr double max_bytes_per_byte = 1100;
constexpr double small_table = 1 << 20;
constexpr hsize_t bytes_at_once = 1 << 20;  ///< of a table that is only checked
constexpr const char* elsewhere =
    ": lies outside this file: mcdem never writes external links; use a file that contains all its data";

/// Must be the first call: disables the library's cleanup at exit. Every file is closed by its owner. A file
/// whose disk was full remains half closed, and the library would crash when it tries again.
[[maybe_unused]] const herr_t no_cleaning_up = H5dont_atexit();

/// Disables printing of error stacks, because our errors contain the reason, and loading of filter programs
/// that a file names.
void set_up_library() {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    H5PLset_loading_state(0);
}

std::string library_reason() {
    std::string reason;
    const auto keep_first = [](unsigned, const H5E_error2_t* error, void* text) -> herr_t {
        auto& reason = *static_cast<std::string*>(text);
        if (reason.empty() && error->desc) reason = error->desc;
        return 0;
    };
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, &reason);
    // An error of the system is sufficient: ".., error message = 'No space left on device', .."
    const std::string before_words = "error message = '";
    const auto words = reason.find(before_words);
    if (words == std::string::npos) return reason;
    const auto begin = words + before_words.size();
    return reason.substr(begin, reason.find('\'', begin) - begin);
}

/// Whether the library could not allocate memory.
bool library_lacks_memory() {
    bool lacks = false;
    const auto visit = [](unsigned, const H5E_error2_t* error, void* lacks) -> herr_t {
        if (error->maj_num == H5E_RESOURCE) *static_cast<bool*>(lacks) = true;
        return 0;
    };
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, visit, &lacks);
    return lacks;
}

/// Whether the data of a table are in other files or tables.
bool lies_elsewhere(hid_t dataset) {
    const Handle layout(H5Dget_create_plist(dataset), H5Pclose);
    return layout < 0 || H5Pget_external_count(layout) != 0 || H5Pget_layout(layout) == H5D_VIRTUAL;
}

Handle checked(hid_t id, Handle::Close close, const FileBelow& file, const std::string& where,
               const char* what) {
    if (id < 0) fail(file, where, what);
    return {id, close};
}

/// Properties of a new object without time stamps, so that the same run gives the same bytes.
Handle without_times(hid_t object_class) {
    Handle properties(H5Pcreate(object_class), H5Pclose);
    H5Pset_obj_track_times(properties, false);
    return properties;
}

/// `mode`: H5F_ACC_TRUNC creates a new HDF5 file.
Handle open_file(FileBelow& below, unsigned mode, const std::string& where) {
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    // The 1.10 format: its metadata have checksums, so damage is detected.
    H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110);
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    use_file(access, below);
    if (mode != H5F_ACC_TRUNC)
        return checked(H5Fopen(where.c_str(), mode, access), H5Fclose, below, where,
                       "cannot be opened as HDF5");
    return checked(H5Fcreate(where.c_str(), mode, without_times(H5P_FILE_CREATE), access), H5Fclose, below,
                   where, "cannot be created");
}

/// The library clears its conversion buffer (1 MiB by default) on every call; for a few rows this takes most
/// of the time.
Handle transfer(const Extent& size, hid_t memory_type) {
    hsize_t bytes = H5Tget_size(memory_type);
    for (hsize_t n : size) bytes *= n;
    Handle properties(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
    H5Pset_buffer(properties, std::clamp<hsize_t>(bytes, 1024, 1024 * 1024), nullptr, nullptr);
    return properties;
}

}  // namespace

Handle text_type(std::size_t length) {
    Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, std::max<std::size_t>(length, 1));
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    H5Tset_cset(type, H5T_CSET_UTF8);
    return type;
}

void fail(const FileBelow& file, const std::string& where, const std::string& what) {
    const std::string message = where + ": " + what, reason = library_reason();
    const bool is_written = file.access() == Access::write, lacks_memory = library_lacks_memory();
    H5Eclear2(H5E_DEFAULT);
    if (file.error() != 0 && !is_written) fail_reading(message, file.error());
    if (file.error() != 0) throw RunError(message + ": " + std::generic_category().message(file.error()));
    const std::string because = reason.empty() ? "" : " (" + reason + ")";
    if (is_written) throw RunError(message + because);
    if (lacks_memory) fail_reading(message, ENOMEM);
    throw InputError(message + because +
                     "; the file is damaged or was not written by this program: restore it from a "
                     "copy or run again");
}

Extent Dataset::extent() const {
    const Handle space = checked(H5Dget_space(id_), H5Sclose, *file_, where_, "has no extent");
    const int rank = H5Sget_simple_extent_ndims(space);
    if (rank < 1) fail("must be a table of rows");
    Extent extent(static_cast<std::size_t>(rank));
    H5Sget_simple_extent_dims(space, extent.data(), nullptr);
    return extent;
}

Handle Dataset::type() const { return checked(H5Dget_type(id_), H5Tclose, *file_, where_, "has no type"); }

Handle Dataset::select(hsize_t first, hsize_t rows) const {
    Extent start = extent(), count = start;
    std::ranges::fill(start, 0);
    start.front() = first;
    count.front() = rows;
    Handle space = checked(H5Dget_space(id_), H5Sclose, *file_, where_, "has no extent");
    if (H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) < 0)
        fail("has no such rows");
    return space;
}

std::size_t Dataset::values_in(hsize_t rows) const {
    const Extent size = extent();
    for (std::size_t k = 1; k < size.size(); ++k) rows *= size[k];
    return static_cast<std::size_t>(rows);
}

void Dataset::set_rows(hsize_t rows) {
    Extent size = extent();
    size.front() = rows;
    if (H5Dset_extent(id_, size.data()) < 0) fail("cannot grow");
}

void Dataset::write_chunk(hsize_t first, std::span<const std::byte> stored) {
    Extent begin(extent().size(), 0);
    begin.front() = first;
    if (H5Dwrite_chunk(id_, H5P_DEFAULT, 0, begin.data(), stored.size(), stored.data()) < 0 ||
        file_->error() != 0)
        fail("cannot be written");
}

void Dataset::read(hid_t memory_type, void* data, hsize_t first, hsize_t rows) const {
    if (first + rows > this->rows()) fail("ends early");
    if (rows == 0) return;
    Extent size = extent();
    size.front() = rows;
    const Handle memory(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose);
    const Handle file = select(first, rows);
    if (H5Dread(id_, memory_type, memory, file, transfer(size, memory_type), data) < 0)
        fail("cannot be read");
}

void Dataset::expect_whole() const {
    const Handle stored = type();
    const hsize_t all = rows(), row_bytes = std::max<hsize_t>(1, values_in(1) * H5Tget_size(stored));
    const hsize_t some = std::max<hsize_t>(1, bytes_at_once / row_bytes);
    std::vector<std::byte> values(std::min(all, some) * row_bytes);
    for (hsize_t first = 0; first < all; first += some)
        read(stored, values.data(), first, std::min(some, all - first));
}

void Dataset::expect_row(const Extent& row) const {
    const Extent found = extent();
    if (!std::equal(found.begin() + 1, found.end(), row.begin(), row.end())) {
        H5Eclear2(H5E_DEFAULT);
        fail("has rows of another size than expected");
    }
}

void Dataset::close() {
    if (id_.close() < 0 || file_->error() != 0) fail("cannot be written");
}

File File::create(NewFile& out) {
    set_up_library();
    File file(std::make_unique<FileBelow>(out.descriptor(), Access::write), out.place());
    file.id_ = open_file(*file.below_, H5F_ACC_TRUNC, file.path_.string());
    return file;
}

File File::open(const std::filesystem::path& path) {
    set_up_library();
    File file(std::make_unique<FileBelow>(open_input(path), Access::read), path);
    file.id_ = open_file(*file.below_, H5F_ACC_RDONLY, path.string());
    return file;
}

File::~File() {
    // The library keeps files that it cannot close: it must not access this one any more.
    if (below_ && id_.close() < 0) below_.release()->forget_file();
}

void File::close() {
    if (H5Fflush(id_, H5F_SCOPE_LOCAL) < 0 || below_->error() != 0) fail(path_.string(), "cannot be written");
    if (id_.close() < 0) {
        FileBelow& kept = *below_.release();
        kept.forget_file();
        h5::fail(kept, path_.string(), "cannot be closed");
    }
    if (below_->error() != 0) fail(path_.string(), "cannot be written");
}

void File::make_group(const std::string& object) {
    const Handle layout = without_times(H5P_GROUP_CREATE);
    for (std::size_t end = 0; end != std::string::npos;) {
        end = object.find('/', end + 1);
        const std::string group = object.substr(0, end);
        if (groups_.insert(group).second)
            close_written(checked(H5Gcreate2(id_, group.c_str(), H5P_DEFAULT, layout, H5P_DEFAULT), H5Gclose,
                                  *below_, where(group), "cannot be created"),
                          group);
    }
}

void File::close_written(Handle handle, const std::string& object) {
    if (handle.close() < 0 || below_->error() != 0) fail(where(object), "cannot be written");
}

bool File::exists(const std::string& object) const {
    const auto has_link = [&](const std::string& link) {
        return answered(H5Lexists(id_, link.c_str(), H5P_DEFAULT), link) > 0;
    };
    // H5Lexists requires all parent groups to exist.
    for (std::size_t end = object.find('/', 1); end != std::string::npos; end = object.find('/', end + 1))
        if (!has_link(object.substr(0, end))) return false;
    return has_link(object);
}

int File::answered(int answer, const std::string& object) const {
    if (answer < 0 && below_->error() != 0) fail(where(object), "cannot be looked for");
    return answer;
}

std::vector<std::string> File::members(const std::string& group) const {
    std::vector<std::string> names;
    const auto keep_name = [](hid_t, const char* name, const H5L_info_t*, void* names) -> herr_t {
        static_cast<std::vector<std::string>*>(names)->emplace_back(name);
        return 0;
    };
    const Handle handle = object(group);
    // HDF5 1.10 crashes if a read fails while it sorts the names of a large group itself.
    if (H5Literate(handle, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, keep_name, &names) < 0)
        fail(where(group), "cannot be listed");
    std::ranges::sort(names);
    return names;
}

Dataset File::create_table(const std::string& object, hid_t type, const Extent& now, const Extent& most,
                           const Extent& chunk, Storage storage) {
    const Handle space(H5Screate_simple(static_cast<int>(now.size()), now.data(), most.data()), H5Sclose);
    if (const auto group = object.rfind('/'); group > 0) make_group(object.substr(0, group));
    const Handle layout = without_times(H5P_DATASET_CREATE);
    H5Pset_chunk(layout, static_cast<int>(chunk.size()), chunk.data());
    if (storage == Storage::compressed) {
        H5Pset_shuffle(layout);
        H5Pset_deflate(layout, 1);  // the level of chunks that others write; ours are filtered by NewTable
    }
    H5Pset_fletcher32(layout);
    return {checked(H5Dcreate2(id_, object.c_str(), type, space, H5P_DEFAULT, layout, H5P_DEFAULT), H5Dclose,
                    *below_, where(object), "cannot be created"),
            *below_, where(object)};
}

void File::expect_inside(const std::string& object) const {
    for (std::size_t end = 0; end != std::string::npos;) {
        end = object.find('/', end + 1);
        const std::string link = object.substr(0, end);
        H5L_info_t info;
        if (link.size() < 2) return;
        if (answered(H5Lget_info(id_, link.c_str(), &info, H5P_DEFAULT), link) < 0) return;  // does not exist
        if (info.type != H5L_TYPE_HARD) throw InputError(where(link) + elsewhere);
    }
}

Dataset File::dataset(const std::string& object) const {
    expect_inside(object);
    Handle id = checked(H5Dopen2(id_, object.c_str(), H5P_DEFAULT), H5Dclose, *below_, where(object),
                        "cannot be found");
    if (lies_elsewhere(id)) throw InputError(where(object) + elsewhere);
    Dataset found(std::move(id), *below_, where(object));
    double bytes = static_cast<double>(H5Tget_size(found.type()));
    for (hsize_t n : found.extent()) bytes *= static_cast<double>(n);
    if (bytes > small_table + max_bytes_per_byte * static_cast<double>(below_->size()))
        fail(where(object), "claims to hold more than the file can");
    return found;
}

std::vector<std::string> File::tables() const {
    std::vector<std::string> names;
    const auto keep_table = [](hid_t, const char* name, const H5O_info_t* info, void* names) -> herr_t {
        if (info->type == H5O_TYPE_DATASET)
            static_cast<std::vector<std::string>*>(names)->push_back(std::string("/") + name);
        return 0;
    };
    if (H5Ovisit2(id_, H5_INDEX_NAME, H5_ITER_NATIVE, keep_table, &names, H5O_INFO_BASIC) < 0)
        fail(path_.string(), "cannot be listed");
    std::ranges::sort(names);
    return names;
}

void File::expect_whole(const std::function<void()>& before_each) const {
    for (const std::string& table : tables()) {
        before_each();
        dataset(table).expect_whole();
    }
}

}  // namespace mcdem::io::h5
