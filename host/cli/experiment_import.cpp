// mcdem experiment import
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdlib.h>

#include <cerrno>
#include <cstring>

#include "cli/experiment.h"
#include "cli/messages.h"
#include "cli/standard_streams.h"
#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/input_file.h"
#include "core/make_folder.h"
#include "experiment/import_experiment.h"
#include "experiment/settings.h"
#include "io/output_folder.h"

namespace mcdem {
namespace {

namespace fs = std::filesystem;

struct ImportCommand {
    std::vector<std::string> tables, settings;
    std::string out, mapping, metadata, name;
    bool gzip = false;
};

std::string text_of_file(const std::string& file) {
    std::error_code error;
    if (!fs::is_regular_file(file, error) || fs::file_size(file, error) > 1'000'000 || error)
        throw InputError(fmt::format("{}: must be a text of at most 1 MB, got {}", file,
                                     fs::exists(file, error) ? "something else" : "no such file"));
    return read_file(file);
}

/// The folder's path in full, without a slash at its end.
fs::path whole_path(const std::string& folder) {
    const fs::path path = fs::absolute(folder).lexically_normal();
    return path.has_filename() ? path : path.parent_path();
}

/// What the tables do not tell; its problems are told with all others.
Experiment known_of(const ImportCommand& command, ExperimentProblems& problems) {
    Experiment known;
    known.recording.plate_start = std::nan("");
    const std::string text = command.metadata.empty() ? "" : text_of_file(command.metadata);
    parse_settings(text, command.metadata.empty() ? "--set" : command.metadata, command.settings, known,
                   problems);
    if (!command.name.empty())
        known.name = command.name;
    else if (known.name.empty())
        known.name = whole_path(command.out).filename().string();
    return known;
}

void print_entry(const std::string& key, const Guess& guess) {
    print_out("{}", wrapped(fmt::format("  {:<13} {:<18} {:<8}", key,
                                        fmt::format("{}", fmt::join(guess.words, " + ")), name(guess.sure)),
                            guess.why));
}

/// What each table is taken for, column by column.
void print_mapping(const Mapping& mapping) {
    for (const MappedTable& table : mapping.tables) {
        const auto more =
            table.files.size() > 1 ? fmt::format(" and {} more", table.files.size() - 1) : std::string();
        print_out("{}{}: {} ({}{}{})\n", table.files.front(), more, name(table.role), name(table.role_sure),
                  table.role_why.empty() ? "" : ": ", table.role_why);
        for (const MappingKey& key : mapping_keys(table.role))
            if (const Guess* guess = table.find(key.name)) print_entry(std::string(key.name), *guess);
        for (const auto& [word, guess] : table.walls) print_entry("wall " + word, guess);
        if (!table.aside.empty())
            print_out("{}", wrapped("  left aside   ", fmt::format("{}", fmt::join(table.aside, ", "))));
    }
}

fs::path kept_mapping(const ImportCommand& command) { return fs::path(command.out) / "mapping.toml"; }

/// Whether the mapping lies in its place already, in the user's own words. Throws InputError where another
/// one does.
bool keeps_mapping(const ImportCommand& command, const std::string& mapping) {
    const fs::path kept = kept_mapping(command);
    if (!fs::exists(kept)) return false;
    if (text_of_file(kept.string()) == mapping || mapping_text(read_mapping(kept)) == mapping) return true;
    throw InputError(
        fmt::format("{}: is another mapping, and is not replaced: give another folder (--out), or remove it",
                    kept.string()));
}

/// The mapping for the user to correct, and every problem.
[[noreturn]] void refuse(const ImportCommand& command, const std::string& mapping,
                         std::vector<std::string> problems, bool wrong_rows) {
    const std::string file = kept_mapping(command).string();
    make_folder(command.out);
    if (!create_file(file, mapping))
        throw InputError(fmt::format("{}: another program has just written it", file));
    problems.push_back(
        wrong_rows
            ? fmt::format("nothing is imported: repair the tables, remove {0}, and import again; or put what "
                          "is right into it, where its entries are wrong, and import with --mapping {0}",
                          file)
            : fmt::format("nothing is imported: put what is right into {0}, without question marks, and "
                          "import again with --mapping {0}",
                          file));
    throw InputError(problems);
}

/// A new folder beside another, removed with what is in it at the end.
class FolderBeside {
public:
    explicit FolderBeside(const fs::path& other) {
        make_folder(other.parent_path());
        std::string pattern = other.string() + ".importing-XXXXXX";
        if (!mkdtemp(pattern.data()))
            throw RunError(fmt::format("{}: cannot be made: {}", pattern, std::strerror(errno)));
        path_ = pattern;
    }
    FolderBeside(const FolderBeside&) = delete;
    FolderBeside& operator=(const FolderBeside&) = delete;
    ~FolderBeside() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

/// Reads it back: what `out` gets can be read. Files are told as they would be in `out`.
void expect_readable(const fs::path& folder, const std::string& out) {
    try {
        read_experiment(folder);
    } catch (const InputError& error) {
        std::vector<std::string> problems{
            "the tables make no experiment that can be read, as they stand in the mapping; it would have:"};
        for (std::string problem : error.problems()) {
            if (problem.starts_with(folder.string())) problem.replace(0, folder.string().size(), out);
            problems.push_back(problem);
        }
        throw InputError(problems);
    }
}

/// Written beside its place and read back first.
void write_whole(const ImportCommand& command, const Experiment& experiment) {
    const fs::path out = whole_path(command.out);
    const FolderBeside beside(out);
    write_experiment(beside.path(), experiment, command.gzip ? Packed::gzip : Packed::plain);
    expect_readable(beside.path(), fs::path(command.out).lexically_normal().string());
    const FolderLock lock = open_output_folder(out);
    expect_free(out);  // still
    for (const char* table : {"contacts.csv", "grains.csv", "plate.csv", "experiment.toml"})
        for (const std::string end : {"", ".gz"})
            if (fs::exists(beside.path() / (table + end)))
                fs::rename(beside.path() / (table + end), out / (table + end));
}

/// The tables by their mapping, or by a guess that is safe; its text is what `out` keeps.
std::vector<ImportTable> tables_of(const ImportCommand& command, const Experiment& known,
                                   const ExperimentProblems& settings, std::string& mapping_toml) {
    const fs::path kept = kept_mapping(command);
    if (!command.mapping.empty()) {
        auto tables = read_import_tables(read_mapping(command.mapping), command.tables);
        const Mapping mapping = mapping_of(tables);
        mapping_toml = command.tables.empty() ? text_of_file(command.mapping) : mapping_text(mapping);
        print_mapping(mapping);
        settings.report();
        return tables;
    }
    if (command.tables.empty())
        throw InputError("TABLE: must be at least one file, or --mapping must name them, got neither");
    if (fs::exists(kept))
        throw InputError(
            fmt::format("{0}: is there already: import with --mapping {0}, or remove it", kept.string()));
    auto tables = guess_tables(command.tables, known);
    const Mapping mapping = mapping_of(tables);
    mapping_toml = mapping_text(mapping);
    print_mapping(mapping);
    std::fflush(stdout);
    auto problems = unclear_entries(mapping_toml, kept.string());
    for (const std::string& problem : settings.lines()) problems.push_back(problem);
    if (problems.empty()) return tables;
    const auto rows = wrong_rows(tables);
    problems.insert(problems.end(), rows.begin(), rows.end());
    refuse(command, mapping_toml, problems, !rows.empty());
}

void run_import(const ImportCommand& command) {
    expect_free(command.out);
    ExperimentProblems settings;
    const Experiment known = known_of(command, settings);
    std::string mapping;
    const auto tables = tables_of(command, known, settings, mapping);
    keeps_mapping(command, mapping);
    const Imported imported = [&] {
        try {
            Imported all = import_tables(tables, known);
            write_whole(command, all.experiment);
            return all;
        } catch (const InputError& error) {
            if (command.mapping.empty()) refuse(command, mapping, error.problems(), true);
            throw;
        }
    }();
    if (!keeps_mapping(command, mapping)) replace_file(kept_mapping(command), mapping);
    for (const std::string& note : imported.notes) spdlog::warn("{}", note);
    const Recording& recording = imported.experiment.recording;
    std::size_t contacts = 0, measured = 0;
    for (const Scan& scan : recording.scans)
        contacts += scan.contacts.size(), measured += scan.position.empty() ? 0 : 1;
    print_out("{}: {} frames, {} grains in {} of them, {} contacts\n", command.out, recording.scans.size(),
              recording.diameter.size(), measured, contacts);
}

}  // namespace

void add_experiment_import(CLI::App& experiment) {
    auto* sub = experiment.add_subcommand("import",
                                          "Make an experiment of a laboratory's or another program's tables");
    auto command = std::make_shared<ImportCommand>();
    sub->add_option(
        "TABLE", command->tables,
        "Tables of the plate, the grains and the contacts: text, dumps of LAMMPS and LIGGGHTS, text "
        "and VTK of Yade; any may be packed with gzip");
    sub->add_option("--out", command->out, "Folder to be made")->required()->type_name("DIR");
    sub->add_option("--mapping", command->mapping,
                    "What the columns are: the mapping.toml that an import without it has written, corrected")
        ->type_name("FILE");
    sub->add_option("--set", command->settings,
                    "What the tables do not tell, by the keys of experiment.toml, such as "
                    "'box.size=[0.165, 0.166]'; may come several times")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    sub->add_option("--metadata", command->metadata, "The same as a file like experiment.toml")
        ->type_name("FILE");
    sub->add_option("--name", command->name,
                    "Name of the experiment (else that of the metadata, or of the folder)")
        ->type_name("TEXT");
    sub->add_flag("--gzip", command->gzip, "Pack the tables");
    sub->footer(
        "Without --mapping it guesses what the columns are and in which units, says so, and writes the guess "
        "as\n"
        "DIR/mapping.toml. Where a guess is not safe, nothing is imported (exit code 2): the lines with a "
        "question mark\n"
        "are to be corrected, and the import repeated with --mapping. Tables given beside --mapping take the "
        "place of\n"
        "those it names: one mapping serves all experiments of a laboratory. The box must be given.\n"
        "z is upwards: in the mapping a minus before a column's name turns it round, z = \"-depth\".\n"
        "Examples:\n"
        "  mcdem experiment import data/plate.csv data/grains.csv data/contacts.csv --set 'box.size=[0.165, "
        "0.166]' \\\n"
        "      --set grains.youngs_modulus=23300 --out out/lab\n"
        "  mcdem experiment import --mapping out/lab/mapping.toml --metadata data/known.toml --out out/lab\n"
        "  mcdem experiment import data/second/* --mapping out/lab/mapping.toml --metadata data/known.toml "
        "--out out/second");
    sub->callback([command] { run_import(*command); });
}

}  // namespace mcdem
