// Protection of existing files. mcdem replaces only files that it wrote itself with the same kind of content,
// recognised by their content. It never replaces a laboratory's table, a scene, a run.h5 or a figure of
// another program, whatever the file name and however the path is spelled. No command reads its own output,
// so inputs are safe as well.
#pragma once
#include <filesystem>
#include <string_view>

namespace mcdem::inline core {

/// Throws InputError unless the path is free, or holds an empty file or the table of a run. Called before
/// long work, and again by replace_table.
void expect_replaceable_table(const std::filesystem::path& file);

/// replace_file, after expect_replaceable_table.
void replace_table(const std::filesystem::path& file, std::string_view text);

/// A folder with the diagnoses of a challenge contains this subfolder.
inline constexpr const char* answers_folder = "evidence";

/// Throws InputError if the folder contains the diagnoses of a challenge.
void expect_no_answers(const std::filesystem::path& folder);

/// Throws InputError if the folder is an experiment folder, where no other output is written.
void expect_no_experiment(const std::filesystem::path& folder);

}  // namespace mcdem::core
