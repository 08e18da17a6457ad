#include "cli/experiment/publish.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <vector>

#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/input_file.h"
#include "core/look.h"
#include "core/sha256.h"
#include "experiment/experiment.h"
#include "io/result_folder.h"

namespace mcdem::inline cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* settings_file = "experiment.toml";
constexpr const char* kept_file = "mapping.toml";
/// In the folder while files are moved there: their SHA-256 and names, as `sha256sum` writes them.
constexpr const char* journal = ".experiment-unfinished";

/// Removes the files of the journal, as far as they are what it says, and the journal last.
void remove_listed(const fs::path& out) {
    std::istringstream lines(read_file(out / journal));
    constexpr std::size_t digits = 64;
    for (std::string line; std::getline(lines, line);) {
        if (line.size() <= digits + 2) continue;
        const fs::path file = out / fs::path(line.substr(digits + 2)).filename();
        if (look_at_itself(file) == At::file && Sha256().add(read_file(file)).hex() == line.substr(0, digits))
            fs::remove(file);
    }
    fs::remove(out / journal);
}

void remove_unfinished(const fs::path& out) {
    if (!is_folder(out) || !is_there(out / journal)) return;
    const FolderLock lock(out, FolderLock::Use::alone);  // refused while another program moves its files
    if (is_there(out / journal)) remove_listed(out);
}

void expect_folder_in_path(const fs::path& out) {
    for (auto path = fs::absolute(out); path.has_relative_path(); path = path.parent_path())
        if (is_there(path) && !is_folder(path))
            throw InputError(fmt::format("--out: {} must be a folder, got a file{}", out.string(),
                                         path.filename() == out.filename()
                                             ? ""
                                             : fmt::format(" in its path, {}", path.filename().string())));
}

void expect_no_other(const fs::path& out) {
    for (const char* taken : {settings_file, "run.h5", "checkpoint.h5"})
        if (is_there(out / taken))
            throw InputError(
                fmt::format("--out: {} holds another experiment or run: name another folder", out.string()));
    for (const char* table : {"contacts.csv", "grains.csv", "plate.csv"})
        for (const char* end : {"", ".gz"})
            if (is_there(out / (std::string(table) + end)))
                throw InputError(
                    fmt::format("--out: {} already contains {}{}, which would become part of this "
                                "experiment: choose another folder, or remove the file first",
                                out.string(), table, end));
    expect_folder_in_path(out);
}

/// One rename. If it cannot be made durable, it is undone.
void move_folder(const fs::path& work, const fs::path& out) {
    try {
        move_file(work, out);
    } catch (const RunError& error) {
        std::error_code refused;
        fs::rename(out, work, refused);  // also refused if it was not moved: `work` is not empty
        if (!refused || is_there(work)) throw;
        throw RunError(
            fmt::format("{}; the experiment is there, whole, but a power cut may remove it: check it by "
                        "`mcdem experiment check {}`",
                        error.what(), out.string()));
    }
}

/// The names of the files in the order in which they are moved.
std::vector<std::string> names_in(const fs::path& work, const fs::path& out) {
    std::vector<std::string> names;
    for (const fs::path& file : entries_of(work)) names.push_back(file.filename().string());
    if (is_there(out / kept_file)) std::erase(names, kept_file);
    std::ranges::sort(names, {},
                      [](const std::string& name) { return std::pair(name == settings_file, name); });
    return names;
}

void move_files(const fs::path& work, const fs::path& out) {
    const FolderLock lock = open_output_folder(out);
    expect_no_other(out);  // checked again
    const auto names = names_in(work, out);
    std::string sums;
    for (const std::string& name : names)
        sums += fmt::format("{}  {}\n", Sha256().add(read_file(work / name)).hex(), name);
    try {
        replace_file(out / journal, sums);
        for (const std::string& name : names) move_file(work / name, out / name);
        fs::remove(out / journal);
    } catch (const std::exception& error) {
        try {
            if (is_there(out / journal)) remove_listed(out);
        } catch (const std::exception&) {
            throw RunError(
                fmt::format("{}; files of it are left in {}: give the same command again, which removes them",
                            error.what(), out.string()));
        }
        throw;
    }
}

}  // namespace

fs::path place_of_work(const fs::path& out) { return is_there(out) ? out / "experiment" : out; }

void expect_free(const fs::path& out) {
    remove_unfinished(out);
    expect_no_other(out);
}

void publish(const fs::path& work, const fs::path& out) {
    if (is_there(out))
        move_files(work, out);
    else
        move_folder(work, out);
}

}  // namespace mcdem::cli
