#include "scene/read_packing.h"

#include <fmt/format.h>

#include <sstream>

#include "core/errors.h"
#include "core/input_file.h"

namespace mcdem::inline scene {

Packing read_packing(const std::filesystem::path& file, std::optional<long> frame) {
    std::error_code error;
    if (!std::filesystem::exists(file, error))
        throw InputError(fmt::format("{}: must be a packing, got no such file", file.string()));
    if (!std::filesystem::is_regular_file(file, error))
        throw InputError(
            fmt::format("{}: must be a packing, got something that is not a file", file.string()));
    constexpr std::uintmax_t largest_file = std::uintmax_t{2} << 30;
    if (std::filesystem::file_size(file, error) > largest_file)
        throw InputError(fmt::format("{}: must be a packing of at most 2 GiB, got more", file.string()));
    const std::string text = read_file(file), source = file.string();
    const std::string_view beginning = std::string_view(text).substr(0, 1 << 16);
    if (beginning.starts_with("\x89HDF\r\n")) {
        if (!read_run_packing) throw InputError(source + ": this program reads no run.h5 as a packing");
        return read_run_packing(file, frame);
    }
    if (beginning.starts_with("\x1f\x8b"))
        throw InputError(fmt::format("{}: must not be packed, got a file of gzip: unpack it", source));
    if (file.extension() == ".csv") {
        std::istringstream input(text);
        return read_csv_packing(input, source, frame);
    }
    if (looks_like_dump(beginning)) return read_dump_packing(text, source, frame);
    if (frame)
        throw InputError(
            fmt::format("{}: must be a dump, grains.csv or run.h5 where packing.frame is given, got a file "
                        "with one packing",
                        source));
    if (looks_like_yade(beginning)) return read_yade_packing(text, source);
    return read_lammps_packing(text, source);
}

}  // namespace mcdem::scene
