// Packings from files. Every problem is reported as `file:line: must be .., got ..`.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "scene/packing/file_packing.h"

namespace mcdem::inline scene {

/// Maximum number of grains in a file.
inline constexpr long largest_packing = 10'000'000;

/// The format is determined by the extension `.csv`, otherwise by the content: a text dump of
/// LIGGGHTS/LAMMPS, Yade's text (`x y z r`), or a LIGGGHTS/LAMMPS data file. `frame`: timestep of a dump
/// (default: the last), or frame of an experiment's grains.csv (default: the first). A run.h5 is read by
/// read_packing_or_run (io/run_packing.h). Throws InputError.
FilePacking read_packing(const std::filesystem::path& file, std::optional<long> frame = {});

/// LIGGGHTS/LAMMPS data file, atom style sphere or granular: lines `id type diameter density x y z` in its
/// `Atoms` section, in metres. Grains are numbered from 0 in the order of the file's ids. Velocities are
/// ignored; density and bounds are returned for comparison with the scene, which sets them.
FilePacking read_lammps_packing(std::string_view text, const std::string& source);

/// CSV with the columns x_m, y_m, z_m, diameter_m in any order, optionally frame, species or type, vx_m_s,
/// vy_m_s, vz_m_s (initial velocity), spin_x_1_s, spin_y_1_s, spin_z_1_s (initial angular velocity), radius_m
/// and density_kg_m3; other columns, such as `grain`, are ignored. Grains are numbered from 0 in the order of
/// the lines.
FilePacking read_csv_packing(const std::string& text, const std::string& source,
                             std::optional<long> frame = {});

// Detection by the first lines. Yade's text may be truncated anywhere.
bool looks_like_dump(std::string_view text);
FilePacking read_dump_packing(std::string_view text, const std::string& source,
                              std::optional<long> step = {});
bool looks_like_yade(std::string_view text);
FilePacking read_yade_packing(std::string_view text, const std::string& source);

}  // namespace mcdem::scene
