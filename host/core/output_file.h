// What mcdem may replace: a file that it wrote itself as what it writes now, told by what the file holds. A
// laboratory's table, a scene, a run.h5, or a figure of another program are none of these, whatever
// their names and however the path is spelled. No command reads what it writes, so that its inputs are safe
// too.
#pragma once
#include <filesystem>
#include <functional>
#include <string_view>

namespace mcdem::inline core {

class NewFile;

/// Files that are written anew by a command that is given again.
enum class FileKind {
    run_table,
    page,
    diagnosis,
    convergence,
    calibration,
    score,
    score_page,
    figure,
    figure_values,
    guide,
    vtk,
    xyz,
    dump,
    manual,
    job_script
};

/// Throws InputError unless nothing, an empty file, or a file of this kind lies there. Asked before long
/// work, and again by those below.
void expect_replaceable(const std::filesystem::path& file, FileKind kind);

/// replace_file, after expect_replaceable.
void replace_own(const std::filesystem::path& file, FileKind kind, std::string_view text);
void replace_own(const std::filesystem::path& file, FileKind kind,
                 const std::function<void(NewFile& out)>& write);

/// A folder of the answers to a challenge holds this one.
inline constexpr const char* answers_folder = "evidence";

/// Throws InputError for the folder of the answers to a challenge.
void expect_no_answers(const std::filesystem::path& folder);

/// Throws InputError for the folder of an experiment: nothing else is written there.
void expect_no_experiment(const std::filesystem::path& folder);

}  // namespace mcdem::core
