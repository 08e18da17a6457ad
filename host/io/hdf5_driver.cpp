#include "io/hdf5_driver.h"

#if __has_include(<H5FDdevelop.h>)
#include <H5FDdevelop.h>
#endif
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace mcdem::inline io::h5 {

void FileBelow::forget_file() {
    if (access_ == Access::read && descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = -1;
}

bool FileBelow::failed(int error) {
    if (error_ == 0) error_ = error;
    return false;
}

bool FileBelow::read(haddr_t first, std::size_t size, std::byte* to) {
    std::size_t done = 0;
    while (done < size) {
        const ssize_t some = ::pread(descriptor_, to + done, size - done, static_cast<off_t>(first + done));
        if (some < 0 && errno == EINTR) continue;
        if (some < 0) return failed(errno);
        if (some == 0) break;
        done += static_cast<std::size_t>(some);
    }
    std::fill(to + done, to + size, std::byte{0});
    for (const Piece& piece : unwritten_) {
        const haddr_t begin = std::max(first, piece.first),
                      end = std::min<haddr_t>(first + size, piece.first + piece.bytes.size());
        if (begin < end)
            std::memcpy(to + (begin - first), piece.bytes.data() + (begin - piece.first), end - begin);
    }
    return true;
}

void FileBelow::write(haddr_t first, std::size_t size, const std::byte* from) {
    std::size_t done = 0;
    while (error_ == 0 && done < size) {
        const ssize_t some =
            ::pwrite(descriptor_, from + done, size - done, static_cast<off_t>(first + done));
        if (some >= 0)
            done += static_cast<std::size_t>(some);
        else if (errno != EINTR)
            failed(errno);
    }
    if (done < size) unwritten_.push_back({first + done, {from + done, from + size}});
}

void FileBelow::set_size(haddr_t size) {
    int result = 0;
    do result = ::ftruncate(descriptor_, static_cast<off_t>(size));
    while (result != 0 && errno == EINTR);
    if (result != 0) failed(errno);
}

haddr_t FileBelow::size() {
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0) failed(errno);
    return static_cast<haddr_t>(status.st_size);
}

namespace {

/// The library's part must come first.
struct Open {
    H5FD_t library;
    FileBelow* below;
    haddr_t allocated, end;
};

Open& open_of(H5FD_t* file) { return *reinterpret_cast<Open*>(file); }
const Open& open_of(const H5FD_t* file) { return *reinterpret_cast<const Open*>(file); }

struct Info {
    FileBelow* below;
};

H5FD_t* open(const char*, unsigned, hid_t properties, haddr_t) {
    const auto* info = static_cast<const Info*>(H5Pget_driver_info(properties));
    if (!info) return nullptr;
    auto* made = new Open{};
    made->below = info->below;
    made->end = info->below->size();
    return &made->library;
}

herr_t close(H5FD_t* file) {
    delete &open_of(file);
    return 0;
}

/// Never equal: each object has a file of its own.
int compare(const H5FD_t* a, const H5FD_t* b) { return a < b ? -1 : a > b; }

/// Flags of the library's own driver for POSIX files, which determine the layout of a file.
herr_t query(const H5FD_t*, unsigned long* flags) {
    *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
             H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
    return 0;
}

haddr_t allocated(const H5FD_t* file, H5FD_mem_t) { return open_of(file).allocated; }
herr_t allocate(H5FD_t* file, H5FD_mem_t, haddr_t end) {
    open_of(file).allocated = end;
    return 0;
}
haddr_t end(const H5FD_t* file, H5FD_mem_t) { return open_of(file).end; }

herr_t read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t first, std::size_t size, void* to) {
    return open_of(file).below->read(first, size, static_cast<std::byte*>(to)) ? 0 : -1;
}

herr_t write(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t first, std::size_t size, const void* from) {
    Open& open = open_of(file);
    open.below->write(first, size, static_cast<const std::byte*>(from));
    open.end = std::max<haddr_t>(open.end, first + size);
    return 0;
}

herr_t truncate(H5FD_t* file, hid_t, hbool_t) {
    Open& open = open_of(file);
    if (open.end != open.allocated) open.below->set_size(open.allocated);
    open.end = open.allocated;
    return 0;
}

hid_t driver() {
    static const hid_t id = [] {
        H5FD_class_t made{};
#ifdef H5FD_CLASS_VERSION
        made.version = H5FD_CLASS_VERSION;
        made.value = static_cast<H5FD_class_value_t>(400);  // one of the values that need no registration
#endif
        made.name = "mcdem";
        made.maxaddr = (haddr_t{1} << 62) - 1;
        made.fc_degree = H5F_CLOSE_WEAK;
        made.fapl_size = sizeof(Info);
        made.open = open;
        made.close = close;
        made.cmp = compare;
        made.query = query;
        made.get_eoa = allocated;
        made.set_eoa = allocate;
        made.get_eof = end;
        made.read = read;
        made.write = write;
        made.truncate = truncate;
        const H5FD_mem_t map[] = H5FD_FLMAP_DICHOTOMY;
        std::copy(std::begin(map), std::end(map), made.fl_map);
        return H5FDregister(&made);
    }();
    return id;
}

}  // namespace

void use_file(hid_t access_properties, FileBelow& file) {
    const Info info{&file};
    H5Pset_driver(access_properties, driver(), &info);
}

}  // namespace mcdem::io::h5
