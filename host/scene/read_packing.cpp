#include "scene/read_packing.h"

#include <fmt/format.h>

#include <sstream>

#include "core/errors.h"
#include "core/input_file.h"
#include "scene/foreign_table.h"

namespace mcdem {

Packing read_packing(const std::filesystem::path& file, std::optional<long> step) {
    std::error_code error;
    if (!std::filesystem::exists(file, error))
        throw InputError(fmt::format("{}: must be a packing, got no such file", file.string()));
    if (!std::filesystem::is_regular_file(file, error))
        throw InputError(
            fmt::format("{}: must be a packing, got something that is not a file", file.string()));
    constexpr std::uintmax_t largest_file = std::uintmax_t{2} << 30;
    if (std::filesystem::file_size(file, error) > largest_file)
        throw InputError(fmt::format("{}: must be a packing of at most 2 GiB, got more", file.string()));
    std::istringstream input(read_file(file));
    if (file.extension() != ".csv") {
        const std::string beginning(input.view().substr(0, 1 << 16));
        if (looks_like_dump(beginning) || looks_like_yade(beginning))
            return packing_of(read_foreign_table(file), step);
    }
    if (step)
        throw InputError(fmt::format(
            "{}: must be a dump where packing.frame is given, got a file with one packing", file.string()));
    return file.extension() == ".csv" ? read_csv_packing(input, file.string())
                                      : read_lammps_packing(input, file.string());
}

}  // namespace mcdem
