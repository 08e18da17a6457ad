#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "experiment/experiment.h"
#include "experiment/measurements.h"
#include "experiment/settings.h"

namespace mcdem {
namespace {

void read_tables(const std::filesystem::path& folder, Experiment& experiment, ExperimentProblems& problems) {
    Recording& recording = experiment.recording;
    const auto plate = find_table(folder, "plate.csv", problems);
    const auto grains = find_table(folder, "grains.csv", problems);
    const auto contacts = find_table(folder, "contacts.csv", problems);
    if (!plate)
        return problems.add(folder.string(),
                            "must hold plate.csv or plate.csv.gz: the plate's position and force by frame");
    Table plate_table(*plate, plate_columns(), problems);
    read_plate(plate_table, recording);
    if (recording.scans.empty())
        return problems.add_once("scans", plate->string(), "must have at least one row");
    if (grains) {
        Table table(*grains, grain_columns(), problems);
        read_grains(table, recording);
    }
    if (!contacts) return;
    if (recording.diameter.empty())
        return problems.add(contacts->string(),
                            "needs grains.csv with the grains of frame 0: contacts name them");
    Table table(*contacts, contact_columns(), problems);
    read_contacts(table, recording);
}

}  // namespace

Experiment read_experiment(const std::filesystem::path& folder) {
    ExperimentProblems problems;
    Experiment experiment;
    const auto settings = folder / "experiment.toml";
    if (!std::filesystem::is_directory(folder)) throw InputError(folder.string() + ": no such folder");
    if (!std::filesystem::exists(settings))
        throw InputError(folder.string() + ": is no experiment, for it holds no experiment.toml");
    read_settings(settings, experiment, problems);
    read_tables(folder, experiment, problems);
    problems.report();
    Recording& recording = experiment.recording;
    recording.label = experiment.name;
    if (std::isnan(recording.plate_start))
        for (const Scan& scan : recording.scans)
            recording.plate_start = std::fmax(recording.plate_start, scan.plate_z);
    average_contacts(recording, experiment.measurement.force_threshold);
    return experiment;
}

}  // namespace mcdem
