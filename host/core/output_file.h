// Protection of existing files. mcdem replaces only files that it wrote itself with the same kind of content,
// recognised by their content. It never replaces a laboratory's table, a scene, a run.h5 or a figure of
// another program, whatever the file name and however the path is spelled. No command reads its own output,
// so inputs are safe as well.
#pragma once
#include <filesystem>
#include <string_view>

namespace mcdem::inline core {

/// Files that a command writes again when it is run again.
enum class FileKind { run_table, convergence, calibration, figure, figure_values };

/// Throws InputError unless the path is free, or holds an empty file or a file of this kind. Called before
/// long work, and again by the functions below.
void expect_replaceable(const std::filesystem::path& file, FileKind kind);

/// replace_file, after expect_replaceable.
void replace_own(const std::filesystem::path& file, FileKind kind, std::string_view text);

/// A folder with the diagnoses of a challenge contains this subfolder.
inline constexpr const char* answers_folder = "evidence";

/// Throws InputError if the folder contains the diagnoses of a challenge.
void expect_no_answers(const std::filesystem::path& folder);

/// Throws InputError if the folder is an experiment folder, where no other output is written.
void expect_no_experiment(const std::filesystem::path& folder);

}  // namespace mcdem::core
