#include "scene/read_packing.h"

#include <fmt/format.h>

#include <fstream>

#include "core/errors.h"

namespace mcdem {

Packing read_packing(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::exists(file, error))
        throw InputError(fmt::format("{}: must be a packing, got no such file", file.string()));
    if (!std::filesystem::is_regular_file(file, error))
        throw InputError(
            fmt::format("{}: must be a packing, got something that is not a file", file.string()));
    constexpr std::uintmax_t largest_file = std::uintmax_t{2} << 30;
    if (std::filesystem::file_size(file, error) > largest_file)
        throw InputError(fmt::format("{}: must be a packing of at most 2 GiB, got more", file.string()));
    std::ifstream input(file, std::ios::binary);
    if (!input)
        throw InputError(
            fmt::format("{}: must be a packing, got a file that cannot be opened", file.string()));
    return file.extension() == ".csv" ? read_csv_packing(input, file.string())
                                      : read_lammps_packing(input, file.string());
}

}  // namespace mcdem
