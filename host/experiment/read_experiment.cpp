#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/errors.h"
#include "core/look.h"
#include "experiment/measurements.h"
#include "experiment/settings.h"

namespace mcdem::inline experiment {
namespace {

constexpr std::uintmax_t largest_settings = 1'000'000;  // bytes

namespace fs = std::filesystem;

void read_tables(const fs::path& folder, std::uintmax_t largest, Experiment& experiment,
                 FileProblems& problems) {
    Recording& recording = experiment.recording;
    const long problems_before = problems.count();
    const auto plate = find_table(folder, "plate.csv", largest, problems);
    const auto grains = find_table(folder, "grains.csv", largest, problems);
    const auto contacts = find_table(folder, "contacts.csv", largest, problems);
    if (problems.count() > problems_before) return;
    if (!plate)
        return problems.add(folder.string(),
                            "must hold plate.csv or plate.csv.gz: the plate's position and force by frame");
    const auto modulus = experiment.materials.find("grains.youngs_modulus");
    const double stiffness =
        modulus == experiment.materials.end() ? std::numeric_limits<double>::infinity() : modulus->second;
    Table plate_table(*plate, plate_columns, largest, problems, plate_columns_of_programmes);
    read_plate(plate_table, stiffness, recording);
    if (recording.scans.empty()) return;
    if (grains) {
        Table table(*grains, grain_columns, largest, problems);
        read_grains(table, recording);
    }
    if (!contacts) return;
    if (grains && recording.diameter.empty()) return;  // already reported
    if (!grains)
        return problems.add(contacts->string(),
                            "needs grains.csv with the grains of frame 0: contacts name them");
    Table table(*contacts, contact_columns, largest, problems);
    read_contacts(table, stiffness, recording);
}

void expect_experiment(const fs::path& folder) {
    const auto settings = folder / "experiment.toml";
    if (!is_there(folder))
        throw InputError(folder.string() + ": must be an experiment's folder, got nothing there");
    if (!is_folder(folder))
        throw InputError(folder.string() + ": must be an experiment's folder, got a file");
    if (look_at_itself(settings) == At::nothing)
        throw InputError(folder.string() + ": is not an experiment: it contains no experiment.toml");
    if (!is_file(settings) || size_of_file(settings) > largest_settings)
        throw InputError(settings.string() + ": must be a text of at most 1 MB that can be read");
}

}  // namespace

Experiment read_experiment(const fs::path& folder, std::uintmax_t largest) {
    FileProblems problems;
    Experiment experiment;
    expect_experiment(folder);
    read_settings(folder / "experiment.toml", experiment, problems);
    read_tables(folder, largest, experiment, problems);
    problems.report();
    Recording& recording = experiment.recording;
    recording.label = experiment.name;
    if (std::isnan(recording.plate_start))
        for (const Scan& scan : recording.scans)
            recording.plate_start = std::fmax(recording.plate_start, scan.plate_z);
    average_contacts(recording, experiment.measurement.force_threshold);
    return experiment;
}

std::vector<Experiment> read_experiments(const std::vector<fs::path>& folders, const std::string& option) {
    std::vector<Experiment> experiments;
    for (const fs::path& folder : folders) {
        if (std::ranges::count(folders, folder) > 1)
            throw InputError(fmt::format("{}: {} is given twice", option, folder.string()));
        experiments.push_back(read_experiment(folder));
        if (folders.size() > 1) experiments.back().name = folder.string();
    }
    if (experiments.empty()) throw InputError(option + ": must name one folder or more, got none");
    return experiments;
}

}  // namespace mcdem::experiment
