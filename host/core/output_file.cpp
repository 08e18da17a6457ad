#include "core/output_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/input_file.h"
#include "core/look.h"

namespace mcdem::inline core {
namespace {

namespace fs = std::filesystem;

/// Mark of a kind: the beginning of the file, and a text within its first bytes.
struct Mark {
    FileKind kind;
    std::string_view what, begins, holds;
};
constexpr std::array marks{
    Mark{FileKind::run_table, "the table of a run", "replica,label,frame,cycle,phase,time_s,", ""},
    Mark{FileKind::convergence, "a table of convergence", "{\n", "\"deviations\""},
    Mark{FileKind::calibration, "a calibration", "{\n", "\"target_top_force_N\""},
    Mark{FileKind::figure, "a figure of mcdem", "", "mcdem figure"},
    Mark{FileKind::figure_values, "the values of figures", "{\n \"mcdem_figures\"", ""},
};
constexpr std::size_t head_size = 1 << 16, largest_figure = 1 << 24;  ///< a PDF names its producer at the end

const Mark& mark_of(FileKind kind) {
    for (const Mark& mark : marks)
        if (mark.kind == kind) return mark;
    throw RunError("no mark of an output");  // not reached: a test covers every kind
}

bool is_of_kind(std::string_view head, FileKind kind) {
    const Mark& mark = mark_of(kind);
    return head.starts_with(mark.begins) && head.find(mark.holds) != head.npos;
}

[[noreturn]] void refuse(const fs::path& file, const std::string& problem) {
    throw InputError(fmt::format("{}: {}; it is not replaced: give another path (--out), or remove it first",
                                 file.string(), problem));
}

}  // namespace

void expect_replaceable(const fs::path& file, FileKind kind) {
    if (look_at_itself(file) == At::nothing) return;
    if (!is_file(file)) refuse(file, "exists and is not a regular file");
    const std::string head = read_beginning(file, kind == FileKind::figure ? largest_figure : head_size);
    if (!head.empty() && !is_of_kind(head, kind)) refuse(file, fmt::format("is not {}", mark_of(kind).what));
}

void replace_own(const fs::path& file, FileKind kind, std::string_view text) {
    expect_replaceable(file, kind);
    remove_temporaries_of(file);
    replace_file(file, text);
}

void expect_no_answers(const fs::path& folder) {
    if (is_folder(folder / answers_folder))
        throw InputError(folder.string() +
                         ": holds the diagnoses of a challenge: give another folder (--out)");
}

void expect_no_experiment(const fs::path& folder) {
    if (is_there(folder / "experiment.toml"))
        throw InputError(fmt::format(
            "{}: is the folder of an experiment, into which nothing else is written: give another "
            "folder (--out)",
            folder.string()));
}

}  // namespace mcdem::core
