// A packing with all that its file says of it.
#pragma once
#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/packing.h"

namespace mcdem::inline scene {

/// What the file of a packing says of its box. Its edges are (size.x, 0, 0), (tilt_xy, size.y, 0) and
/// (tilt_xz, tilt_yz, size.z), from the corner `low`.
struct StatedBox {
    enum class Face { unknown, periodic, fixed, moving };
    std::string where;                             ///< "dump:5"
    Vec3 low = Vec3::Zero(), size = Vec3::Zero();  ///< [m]
    double tilt_xy = 0, tilt_xz = 0, tilt_yz = 0;  ///< [m]
    std::array<Face, 6> face{};                    ///< x_min, x_max, .. z_max; moving: follows the grains
    std::optional<ContainerShape> shape = {};      ///< of a run: its box is its container
    Vec3 high() const { return low + size; }
};

struct FilePacking : Packing {
    std::optional<StatedBox> box = {};     ///< if the file has lines about it
    std::vector<double> density = {};      ///< of each grain [kg/m3]; empty if the file does not say
    std::vector<std::string> unread = {};  ///< columns of a CSV file that mean nothing here
};

/// Reads the packing of a file; `frame` as in read_packing. Throws InputError.
using PackingReader =
    std::function<FilePacking(const std::filesystem::path& file, std::optional<long> frame)>;

}  // namespace mcdem::scene
