#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/experiment/experiment.h"
#include "cli/experiment/publish.h"
#include "cli/shell/commands.h"
#include "cli/shell/messages.h"
#include "cli/shell/python_program.h"
#include "cli/shell/standard_streams.h"
#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/input_file.h"
#include "core/look.h"
#include "core/make_folder.h"
#include "core/parameters.h"
#include "experiment/settings.h"

namespace mcdem::inline cli {
namespace {

namespace fs = std::filesystem;
constexpr double largest_voxel = 1;  // [m]

struct ImportCommand {
    std::vector<std::string> tables, settings;
    std::string out, mapping, metadata, name;
    std::optional<double> voxel_size;  ///< [m]
    bool gzip = false;
};

std::string text_of_file(const std::string& file) {
    if (!is_file(file) || size_of_file(file) > 1'000'000)
        throw InputError(fmt::format("{}: must be a text of at most 1 MB, got {}", file,
                                     is_there(file) ? "something else" : "no such file"));
    return read_file(file);
}

/// Values that are not in the tables; their problems are reported together with all others.
Experiment known_of(const ImportCommand& command, FileProblems& problems) {
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

fs::path kept_mapping(const ImportCommand& command) { return fs::path(command.out) / "mapping.toml"; }

/// What host/python/mcdem/importing/__main__.py reads; null: not known.
nlohmann::json request_of(const ImportCommand& command, const Experiment& known,
                          const FileProblems& settings) {
    const auto material = [&](const std::string& key) {
        const auto found = known.materials.find(key);
        return found == known.materials.end() ? std::nan("") : found->second;
    };
    const Recording& recording = known.recording;
    return {{"known",
             {{"box", {recording.box.size_x, recording.box.size_y}},
              {"shape", name(recording.box.shape)},
              {"plate_start", recording.plate_start},
              {"youngs_modulus", material("grains.youngs_modulus")},
              {"poisson_ratio", material("grains.poisson_ratio")},
              {"voxel_size", command.voxel_size.value_or(std::nan(""))},
              {"programme", has_programme(recording.parameters)}}},
            {"gzip", command.gzip},
            {"settings_problems", settings.lines()}};
}

/// Reads the tables into the folder `work`. Files are arguments because their names may not be valid UTF-8.
int read_tables(const ImportCommand& command, const nlohmann::json& request, const fs::path& work) {
    replace_file(work / "request.json",
                 request.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    std::vector<std::string> words{work.string(), kept_mapping(command).string(), command.mapping};
    words.insert(words.end(), command.tables.begin(), command.tables.end());
    return run_python_module("mcdem.importing", words);
}

/// Reports all problems, with the mapping for the user to correct.
[[noreturn]] void refuse(const ImportCommand& command, const fs::path& work,
                         std::vector<std::string> problems, bool wrong_rows) {
    const std::string file = kept_mapping(command).string();
    make_folder(command.out);
    if (!create_file(file, read_file(work / "mapping.toml")))
        throw InputError(fmt::format("{}: another program has just written it", file));
    problems.push_back(
        wrong_rows
            ? fmt::format("nothing is imported: repair the tables, remove {0} and import again; or correct "
                          "the wrong entries of {0} and import with --mapping {0}",
                          file)
            : fmt::format("nothing is imported: correct the entries of {0} that begin with a question mark, "
                          "remove the marks, and import again with --mapping {0}",
                          file));
    throw InputError(problems);
}

void print_summary(const std::string& out, const Recording& recording) {
    std::size_t contacts = 0, measured = 0;
    for (const Scan& scan : recording.scans)
        contacts += scan.contacts.size(), measured += scan.position.empty() ? 0 : 1;
    print_out("{}: {} frames, {} grains in {} of them, {} contacts\n", out, recording.scans.size(),
              recording.diameter.size(), measured, contacts);
}

/// The folder in `work` with all files of the experiment and no others.
fs::path experiment_of(const fs::path& work, const Experiment& known) {
    const fs::path whole = work / "experiment";
    make_folder(whole);
    for (const std::string name : {"contacts.csv", "grains.csv", "plate.csv"})
        for (const std::string end : {"", ".gz"})
            if (is_there(work / (name + end))) move_file(work / (name + end), whole / (name + end));
    replace_file(whole / "mapping.toml", read_file(work / "mapping.toml"));
    replace_file(whole / "experiment.toml", settings_text(known));
    return whole;
}

int run_import(const ImportCommand& command) {
    expect_free(command.out);
    if (command.voxel_size && !(*command.voxel_size > 0 && *command.voxel_size <= largest_voxel))
        throw InputError(fmt::format("--voxel-size: must be > 0 and <= {} [m], got {}", largest_voxel,
                                     *command.voxel_size));
    FileProblems settings;
    Experiment known = known_of(command, settings);
    const fs::path out = whole_path(command.out);
    const fs::path place = place_of_work(out);
    make_folder(place.parent_path());
    remove_temporaries_of(place);
    const NewFolder beside(place);
    const fs::path& work = beside.path();
    const int exit_code = read_tables(command, request_of(command, known, settings), work);
    if (exit_code != exit_done) return exit_code;
    const auto result = nlohmann::json::parse(read_file(work / "result.json"));
    if (result.contains("problems")) refuse(command, work, result["problems"], result["wrong_rows"]);
    if (std::isnan(known.recording.plate_start))
        known.recording.plate_start = std::stod(result["plate_start"].get<std::string>());
    const fs::path whole = experiment_of(work, known);
    try {
        const Experiment read = read_back(whole, fs::path(command.out).lexically_normal().string(),
                                          "with this mapping the tables do not give a valid experiment:");
        publish(whole, out);
        for (const std::string note : result["notes"]) spdlog::warn("{}", note);
        print_summary(command.out, read.recording);
    } catch (const InputError& error) {
        if (command.mapping.empty()) refuse(command, work, error.problems(), true);
        throw;
    }
    return exit_done;
}

}  // namespace

void add_experiment_import(CLI::App& experiment, int& exit_code) {
    auto* sub = experiment.add_subcommand(
        "import", "Make an experiment from the tables of a laboratory or another program");
    auto command = std::make_shared<ImportCommand>();
    sub->add_option(
        "TABLE", command->tables,
        "Tables of the plate, the grains and the contacts: text, dumps of LAMMPS and LIGGGHTS, text "
        "and VTK of Yade, extended xyz, regions of scikit-image, trackpy's and SPAM's tables; any may be "
        "packed with gzip");
    sub->add_option("--out", command->out, "Folder to create")->required()->type_name("DIR");
    sub->add_option("--mapping", command->mapping,
                    "Meaning of the columns: the mapping.toml written by an import without this option, "
                    "corrected by hand")
        ->type_name("FILE");
    sub->add_option("--set", command->settings,
                    "Set a key of experiment.toml that the tables do not contain, such as 'box.size=[0.165, "
                    "0.166]'; may be repeated")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    sub->add_option("--metadata", command->metadata, "The same from a file in the format of experiment.toml")
        ->type_name("FILE");
    sub->add_option("--voxel-size", command->voxel_size,
                    "Edge length of a voxel [m], for tables of images in voxels")
        ->type_name("LENGTH");
    sub->add_option("--name", command->name,
                    "Name of the experiment (default: that of the metadata, or of the folder)")
        ->type_name("TEXT");
    sub->add_flag("--gzip", command->gzip, "Compress the tables with gzip");
    sub->footer(
        "Without --mapping the meaning and units of the columns are guessed, reported and written to\n"
        "DIR/mapping.toml. If a guess is uncertain, nothing is imported (exit code 2): correct the lines "
        "with a\n"
        "question mark and repeat the import with --mapping. Tables given with --mapping replace those it "
        "names, so one\n"
        "mapping serves all experiments of a laboratory. The box must be given.\n"
        "z points upwards; in the mapping a minus sign before a column's name reverses it: z = \"-depth\".\n"
        "Examples:\n"
        "  mcdem experiment import data/plate.csv data/grains.csv data/contacts.csv --set 'box.size=[0.165, "
        "0.166]' \\\n"
        "      --set grains.youngs_modulus=23300 --out out/lab\n"
        "  mcdem experiment import --mapping out/lab/mapping.toml --metadata data/known.toml --out out/lab\n"
        "  mcdem experiment import data/second/* --mapping out/lab/mapping.toml --metadata data/known.toml "
        "--out out/second");
    sub->callback([command, &exit_code] { exit_code = run_import(*command); });
}

}  // namespace mcdem::cli
