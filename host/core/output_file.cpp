#include "core/output_file.h"

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/input_file.h"
#include "core/look.h"

namespace mcdem::inline core {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view table_begins = "replica,label,frame,cycle,phase,time_s,";

[[noreturn]] void refuse(const fs::path& file, const std::string& problem) {
    throw InputError(fmt::format("{}: {}; it is not replaced: give another path (--out), or remove it first",
                                 file.string(), problem));
}

}  // namespace

void expect_replaceable_table(const fs::path& file) {
    if (look_at_itself(file) == At::nothing) return;
    if (!is_file(file)) refuse(file, "exists and is not a regular file");
    const std::string head = read_beginning(file, table_begins.size());
    if (!head.empty() && head != table_begins) refuse(file, "is not the table of a run");
}

void replace_table(const fs::path& file, std::string_view text) {
    expect_replaceable_table(file);
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
