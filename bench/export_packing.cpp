// Writes a dense packing for other codes, with all parameters that they need for the same run.
#include <fmt/format.h>

#include <exception>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>

#include "bench/dense_packing.h"
#include "core/atomic_file.h"
#include "sim/device_replica.h"

namespace {

using namespace mcdem;

/// LIGGGHTS and LAMMPS data file, atom style sphere: id type diameter density x y z.
std::string data_file(const bench::DensePacking& dense, double density) {
    std::string text = fmt::format(
        "Dense packing\n\n{} atoms\n2 atom types\n\n{} {} xlo xhi\n{} {} ylo yhi\n{} {} zlo zhi\n\nAtoms\n\n",
        dense.packing.size(), -0.01, dense.box.size_x + 0.01, -0.01, dense.box.size_y + 0.01, -0.01,
        dense.height + 0.05);
    for (std::size_t i = 0; i < dense.packing.size(); ++i) {
        const Vec3& p = dense.packing.position[i];
        text += fmt::format("{} 1 {} {} {} {} {}\n", i + 1, dense.packing.diameter[i], density, p.x(), p.y(),
                            p.z());
    }
    return text;
}

nlohmann::json parameters(const bench::DensePacking& dense, const Replica& replica) {
    return {{"grains", dense.packing.size()},
            {"size_x", dense.box.size_x},
            {"size_y", dense.box.size_y},
            {"height", dense.height},
            {"diameter", std::accumulate(dense.packing.diameter.begin(), dense.packing.diameter.end(), 0.0) /
                             dense.packing.size()},
            {"time_step", time_step(replica, dense.packing)},
            {"youngs_modulus", replica.grains.youngs_modulus},
            {"poisson_ratio", replica.grains.poisson_ratio},
            {"density", replica.grains.density},
            {"friction", replica.grains.friction},
            {"restitution", replica.grains.restitution},
            {"wall_youngs_modulus", replica.walls.youngs_modulus},
            {"plate_speed", replica.plate.speed}};
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        fmt::print(stderr, "usage: export_packing GRAINS FOLDER\n");
        return 2;
    }
    try {
        const auto dense = bench::dense_packing(std::stoi(argv[1]), MCDEM_BENCH_CACHE);
        const std::filesystem::path folder = argv[2];
        std::filesystem::create_directories(folder);
        const Replica replica;
        replace_file(folder / "packing.data", data_file(dense, replica.grains.density));
        replace_file(folder / "parameters.json", parameters(dense, replica).dump(1) + "\n");
    } catch (const std::exception& error) {
        fmt::print(stderr, "export_packing: {}\n", error.what());
        return 1;
    }
    return 0;
}
