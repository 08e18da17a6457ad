#include "ensemble/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <type_traits>

#include "core/errors.h"
#include "core/input_file.h"
#include "core/look.h"
#include "core/sha256.h"
#include "diagnose/infer/library.h"
#include "ensemble/diagnosis/observation_store.h"
#include "ensemble/parts/manifest.h"
#include "experiment/experiment.h"
#include "io/checkpoint.h"
#include "io/csv.h"
#include "io/result_file.h"
#include "io/result_folder.h"
#include "io/results.h"

namespace mcdem::inline ensemble {
namespace {

namespace fs = std::filesystem;

/// `check` may return what could not be checked, and throws InputError if the file is damaged.
template <class Check>
void look(std::vector<Verified>& all, const fs::path& file, Check check) {
    try {
        std::string note;
        if constexpr (std::is_void_v<decltype(check())>)
            check();
        else
            note = check();
        all.push_back({file, true, note});
    } catch (const InputError& error) {
        all.push_back({file, false, error.what()});
    }
}

std::vector<fs::path> sorted_files(const fs::path& folder) {
    std::vector<fs::path> files = entries_of(folder);
    std::ranges::sort(files);
    return files;
}

std::string check_result_file(const fs::path& file) {
    read_run(file);
    const ResultFile result(file);
    if (!result.has_digests()) return "it has no digests: written by an older version; all of it can be read";
    result.expect_whole();
    return "";
}

void check_plate_table(const fs::path& folder) {
    if (read_file(folder / "plate.csv") != csv_text(read_run(folder, ReadWhat::observables)))
        throw InputError("it is not what run.h5 gives: `mcdem run .. --resume` writes it again");
}

/// Reports files of an experiment that are not listed.
void check_listed(const fs::path& folder, const std::set<std::string>& listed, std::vector<Verified>& all) {
    for (const std::string name : {"contacts.csv", "contacts.csv.gz", "experiment.toml", "grains.csv",
                                   "grains.csv.gz", "plate.csv", "plate.csv.gz"})
        if (!listed.contains(name) && is_there(folder / name))
            all.push_back({folder / name, false,
                           fmt::format("{} does not name it: it was added later, or its line was taken out",
                                       sums_file)});
}

/// Checks a file in the format of `sha256sum`.
void check_sums(const fs::path& folder, std::vector<Verified>& all) {
    std::set<std::string> listed;
    std::istringstream sums(read_file(folder / sums_file));
    constexpr std::size_t digits = 64;
    for (std::string line; std::getline(sums, line);) {
        const fs::path file =
            line.size() > digits + 2 ? folder / line.substr(digits + 2) : folder / sums_file;
        listed.insert(file.filename().string());
        look(all, file, [&] {
            if (line.size() <= digits + 2 || fs::path(line.substr(digits + 2)).has_parent_path())
                throw InputError("its lines must be a SHA-256 and the name of a file in the same folder");
            if (Sha256().add(read_file(file)).hex() != line.substr(0, digits))
                throw InputError(std::string("it has another SHA-256 than ") + sums_file +
                                 " says: it was changed");
        });
    }
    check_listed(folder, listed, all);
}

/// Checks the manifests of work in the folder.
void check_manifests(const fs::path& folder, std::vector<Verified>& all) {
    for (const fs::path& file : {manifest_file(folder), device_file(folder)})
        if (is_there(file))
            look(all, file, [&] {
                if (!read_manifest(file)) throw InputError("it is damaged");
            });
}

void check_run(const fs::path& folder, std::vector<Verified>& all) {
    const auto result = [&](const fs::path& file) {
        look(all, file, [&] { return check_result_file(file); });
    };
    if (is_there(run_file(folder))) {
        result(run_file(folder));
        if (is_there(folder / "plate.csv"))
            look(all, folder / "plate.csv", [&] { check_plate_table(folder); });
    }
    if (has_checkpoint(folder))
        look(all, folder / "checkpoint.h5", [&] { expect_whole_checkpoint(folder / "checkpoint.h5"); });
    try {
        for (const fs::path& segment : segment_files(folder)) result(segment);
    } catch (const InputError& error) {
        all.push_back({folder, false, error.what()});
    }
    const fs::path parts = parts_folder(folder);
    if (!is_folder(parts)) return;
    check_manifests(parts, all);
    for (const fs::path& entry : entries_of(parts))
        if (is_folder(entry)) check_run(entry, all);
    for (const fs::path& file : sorted_files(parts))
        if (file.extension() == ".h5") result(file);
}

/// Checks a diagnosis or a library: library.json, and all stored simulations.
void check_library(const fs::path& folder, std::vector<Verified>& all) {
    if (is_there(folder / "library.json"))
        look(all, folder / "library.json", [&] { read_library(folder / "library.json"); });
    const fs::path simulations = folder / "simulations";
    if (!is_folder(simulations)) return;
    for (const fs::path& file : sorted_files(simulations)) {
        if (file.extension() == ".h5") look(all, file, [&] { return check_result_file(file); });
        if (file.extension() == ".obs")
            look(all, file, [&] {
                if (!read_observation(file))
                    throw InputError("its digest does not match: it is simulated again when it is needed");
            });
    }
}

/// A library may have any name.
bool is_json(const fs::path& file) {
    return file.extension() == ".json" || (is_file(file) && read_beginning(file, 1) == "{");
}

/// Checks a file outside of its folder.
void look_alone(std::vector<Verified>& all, const fs::path& file) {
    const bool is_library = is_json(file);
    if (file.extension() != ".h5" && !is_library)
        throw InputError(file.string() +
                         ": must be a folder, a .h5 file of a run or the .json of a library: other files are "
                         "verified with the folder that they are in");
    look(all, file, [&]() -> std::string {
        if (is_library)
            read_library(file);
        else if (file.filename().string().starts_with("checkpoint."))
            expect_whole_checkpoint(file);
        else
            return check_result_file(file);
        return "";
    });
}

}  // namespace

std::vector<Verified> verify(const fs::path& path) {
    std::vector<Verified> all;
    if (!is_folder(path)) {
        look_alone(all, path);
        return all;
    }
    check_run(path, all);
    check_manifests(path, all);
    check_library(path, all);
    if (is_there(path / sums_file))
        check_sums(path, all);
    else if (is_there(path / "experiment.toml"))
        look(all, path / "experiment.toml", [&] {
            read_experiment(path);
            return fmt::format("the experiment has no {}; all of it can be read", sums_file);
        });
    if (all.empty())
        throw InputError(path.string() +
                         ": holds no run, experiment, diagnosis or library that could be verified");
    return all;
}

}  // namespace mcdem::ensemble
