// File driver below the HDF5 library: plain reads and writes of one open file. The library loses errors that
// occur while it closes an object, and is left in an inconsistent state. Therefore a failed write is recorded
// here and all later writes are kept in memory, so that the library finishes as if nothing had happened. The
// owner of the file then checks for the error.
#pragma once
#include <hdf5.h>

#include <cstddef>
#include <string>
#include <vector>

namespace mcdem::inline io::h5 {

enum class Access { read, write };

/// One open file and its first error. A file for reading is closed with this object, a file for writing by
/// its owner.
class FileBelow {
public:
    FileBelow(int descriptor, Access access) : descriptor_(descriptor), access_(access) {}
    ~FileBelow() { forget_file(); }
    FileBelow(const FileBelow&) = delete;
    FileBelow& operator=(const FileBelow&) = delete;

    Access access() const { return access_; }
    /// First error of the system as in errno; 0: none.
    int error() const { return error_; }

    /// False if the file cannot be read; beyond its end it reads zeros.
    bool read(haddr_t first, std::size_t size, std::byte* to);
    void write(haddr_t first, std::size_t size, const std::byte* from);
    void set_size(haddr_t size);
    haddr_t size();
    /// Ignores all further reads and writes, for files that the library could not close.
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
    std::vector<Piece> unwritten_;  ///< writes since the first error, in order
};

/// Makes the library use `file` for any file name; `file` must outlive the library's file.
void use_file(hid_t access_properties, FileBelow& file);

}  // namespace mcdem::io::h5
