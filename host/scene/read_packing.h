// Packings from files. Every problem is reported as `file:line: must be .., got ..`.
#pragma once
#include <filesystem>
#include <istream>
#include <optional>
#include <string>
#include <string_view>

#include "core/packing.h"

namespace mcdem::inline scene {

/// The most grains that a file may hold.
inline constexpr long largest_packing = 10'000'000;

/// By its name's end `.csv`, else by its content: a text dump of LIGGGHTS/LAMMPS, Yade's text (`x y z r`),
/// anything else a LIGGGHTS/LAMMPS data file. `frame`: the timestep of a dump, its last where left out; the
/// frame of an experiment's grains.csv or of a run, their first where left out. Throws InputError.
Packing read_packing(const std::filesystem::path& file, std::optional<long> frame = {});

/// Reads a run.h5. Scenes know nothing of HDF5: programs put io's reader here.
using RunPackingReader = Packing (*)(const std::filesystem::path& file, std::optional<long> frame);
inline RunPackingReader read_run_packing = nullptr;

/// LIGGGHTS/LAMMPS data file, atom style sphere or granular: lines `id type diameter density x y z` in
/// its `Atoms` section, in metres. Grains are numbered from 0 in the order of the file's ids. Density,
/// bounds and velocities are left aside: the scene says what they are.
Packing read_lammps_packing(std::istream& input, const std::string& source);

/// CSV with the columns x_m, y_m, z_m, diameter_m in any order, perhaps frame and species or type; others,
/// such as `grain`, are left aside. Grains are numbered from 0 in the order of the lines.
Packing read_csv_packing(std::istream& input, const std::string& source, std::optional<long> frame = {});

// By what they begin with. Yade's text may be cut anywhere.
bool looks_like_dump(std::string_view text);
Packing read_dump_packing(std::string_view text, const std::string& source, std::optional<long> step = {});
bool looks_like_yade(std::string_view text);
Packing read_yade_packing(std::string_view text, const std::string& source);

}  // namespace mcdem::scene
