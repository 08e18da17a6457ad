// What lies below the HDF5 library: plain reads and writes of one open file. The library loses what fails
// while it closes an object, and is left half closed. So a write that failed is remembered here, all after it
// is kept in memory alone, and the library goes on to its end as if nothing had happened; the file's owner
// then asks.
#pragma once
#include <hdf5.h>

#include <cstddef>
#include <string>
#include <vector>

namespace mcdem::inline io::h5 {

enum class Access { read, write };

/// One open file and what the system said of it. One that is read is closed with this, one that is written by
/// its owner.
class FileBelow {
public:
    FileBelow(int descriptor, Access access) : descriptor_(descriptor), access_(access) {}
    ~FileBelow() { forget_file(); }
    FileBelow(const FileBelow&) = delete;
    FileBelow& operator=(const FileBelow&) = delete;

    Access access() const { return access_; }
    /// The first error of the system, a number as in errno; 0: none.
    int error() const { return error_; }

    /// False where the file cannot be read; behind its end lie zeros.
    bool read(haddr_t first, std::size_t size, std::byte* to);
    void write(haddr_t first, std::size_t size, const std::byte* from);
    void set_size(haddr_t size);
    haddr_t size();
    /// Nothing is read or written any more: where the library could not let go of it.
    void forget_file();

private:
    struct Piece {
        haddr_t first;
        std::vector<std::byte> bytes;
    };
    bool failed(int error);
    int descriptor_;
    Access access_;
    int error_ = 0;
    std::vector<Piece> unwritten_;  ///< what was to be written since the first error, in order
};

/// Makes the library use `file`, whatever name it is given; `file` must outlive the library's.
void use_file(hid_t access_properties, FileBelow& file);

}  // namespace mcdem::io::h5
