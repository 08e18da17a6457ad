#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "cli/experiment/experiment.h"
#include "cli/experiment/publish.h"
#include "cli/shell/commands.h"
#include "cli/shell/messages.h"
#include "cli/shell/standard_streams.h"
#include "core/atomic_file.h"
#include "core/container.h"
#include "core/errors.h"
#include "core/input_file.h"
#include "core/make_folder.h"
#include "core/parameters.h"
#include "diagnose/effects.h"
#include "experiment/instrument.h"
#include "io/results.h"
#include "scene/packing/packing_fields.h"
#include "scene/programme/programme_text.h"

namespace mcdem::inline cli {
namespace {

namespace fs = std::filesystem;

struct FromRunCommand {
    std::string run, out, replica, name;
    Instrument instrument{{1e-4, 5e-5, 0.05, 4e-3}};
    std::vector<std::string> uncertainty;
    std::uint64_t seed = 1;
    bool gzip = false;
};

std::size_t chosen_replica(const Run& run, const FromRunCommand& command) {
    const auto& all = run.recordings;
    std::string known;
    for (std::size_t r = 0; r < all.size(); ++r) {
        if (all[r].label == command.replica) return r;
        known += fmt::format("{}{}{}", r ? ", " : "", r, all[r].label.empty() ? "" : ": " + all[r].label);
    }
    const auto index = to_whole_number(command.replica);
    if (index && *index >= 0 && static_cast<std::size_t>(*index) < all.size())
        return static_cast<std::size_t>(*index);
    if (command.replica.empty() && all.size() == 1) return 0;
    throw InputError(fmt::format("--replica: must be a number or label of {}'s replicas ({}); got {}",
                                 command.run, known, command.replica.empty() ? "none" : command.replica));
}

Recording read_replica(const FromRunCommand& command) {
    RunReader reader(command.run);
    const std::size_t replica = chosen_replica(reader.run(), command);
    Recording recording = reader.run().recordings[replica];
    for (std::size_t s = 0; s < recording.scans.size(); ++s)
        recording.scans[s] = reader.read_scan(replica, s);
    recording.label = reader.run().name + (recording.label.empty() ? "" : ", " + recording.label);
    if (recording.diameter.empty()) throw InputError(command.run + ": holds no grains of this replica");
    if (recording.scans.empty()) throw InputError(command.run + ": holds no scan of this replica");
    for (const Scan& scan : recording.scans)
        if (!std::isfinite(scan.top_force()) || !std::isfinite(scan.plate_z))
            throw InputError(
                fmt::format("{}: frame {} of this replica has a top force or plate position that is not a "
                            "number",
                            command.run, scan.frame));
    if (recording.failure) spdlog::warn("{} stopped early: {}", recording.label, recording.failure->cause);
    return recording;
}

std::map<std::string, double> read_uncertainty(const std::vector<std::string>& words) {
    std::map<std::string, double> uncertainty;
    std::vector<std::string> problems;
    for (const std::string& word : words) {
        const auto equals = std::min(word.find('='), word.size());
        const std::string key = word.substr(0, equals);
        const auto sigma = to_number(std::string_view(word).substr(std::min(equals + 1, word.size())));
        const auto& keys = material_keys();
        if (std::find(keys.begin(), keys.end(), key) == keys.end() || !sigma || *sigma < 0)
            problems.push_back(fmt::format("--uncertainty: must be KEY=SIGMA with a key such as {}, got {}",
                                           keys.front(), word));
        else
            uncertainty[key] = *sigma;
    }
    if (!problems.empty()) throw InputError(problems);
    return uncertainty;
}

/// With errors of the order of the grain size the result could not be read back.
void expect_small_errors(const Measurement& errors, const Recording& truth) {
    const double limit = *std::min_element(truth.diameter.begin(), truth.diameter.end()) / 8;
    std::vector<std::string> problems;
    for (const auto& [option, error] : {std::pair{"--position-error", errors.position_error},
                                        std::pair{"--diameter-error", errors.diameter_error}})
        if (error > limit)
            problems.push_back(
                fmt::format("{}: must be at most an eighth of the smallest diameter, {:.3g} m, got {}",
                            option, limit, error));
    if (!problems.empty()) throw InputError(problems);
}

/// Each frame of an experiment with a programme is a scan of its stages.
void expect_all_scans(const Recording& truth) {
    const auto scans =
        scan_places(programme_of(truth.parameters), {truth.plate_start, 0}).size();  // plus one at rest
    if (truth.scans.size() == scans + 1) return;
    throw InputError(fmt::format(
        "the run must have the {} scans of its programme and one before them, at rest, got {}: run it to its "
        "end, with protocol.scan_at_start = true",
        scans, truth.scans.size()));
}

void warn_of_start(const Recording& truth) {
    if (has_programme(truth.parameters) && !is_cell(truth.box))
        expect_all_scans(truth);  // cells are refused later
    if (!truth.species_names.empty())
        throw InputError(
            "the run must be one of grains of one material, got one of [[species]]: experiments state one "
            "material only");
    const Scan& first = truth.scans.front();
    if (first.position.empty())
        spdlog::warn(
            "the run holds no positions of frame 0: grains.csv and contacts.csv are left out. Run with "
            "output.positions = true");
    else if (truth.displacement(first) > 0)
        spdlog::warn(
            "frame 0 is {:.3g} mm below the plate's start, not the packing at rest that a simulation "
            "should start from. Run with protocol.scan_at_start = true",
            1e3 * truth.displacement(first));
}

/// In a folder of its own first, so that a killed call leaves no part of an experiment.
void write_files(const FromRunCommand& command, const Experiment& experiment) {
    auto files = experiment_files(experiment, command.gzip ? Packed::gzip : Packed::plain);
    files[sums_file] = sums_text(files);
    const fs::path out = whole_path(command.out);
    const fs::path place = place_of_work(out);
    make_folder(place.parent_path());
    remove_temporaries_of(place);
    const NewFolder beside(place);
    const fs::path work = beside.path() / "experiment";
    make_folder(work);
    for (const auto& [name, bytes] : files) replace_file(work / name, bytes);
    // A run that was changed by others, or an instrument with extreme errors, may give data that no reader
    // accepts.
    read_back(work, command.out,
              command.run +
                  ": does not give a valid experiment, so nothing is written. Run the scene again, or lower "
                  "the measurement errors. Problems:");
    publish(work, out);
}

void make_experiment(const FromRunCommand& command) {
    expect_free(command.out);
    const auto uncertainty = read_uncertainty(command.uncertainty);
    const Recording truth = read_replica(command);
    expect_small_errors(command.instrument.stated, truth);
    warn_of_start(truth);
    Experiment experiment = experiment_from(truth, command.instrument, command.seed);
    experiment.uncertainty = uncertainty;
    if (!command.name.empty()) experiment.name = command.name;
    write_files(command, experiment);
    std::size_t real = 0, seen = 0;
    for (const Scan& scan : truth.scans) real += scan.contacts.size();
    for (const Scan& scan : experiment.recording.scans) seen += scan.contacts.size();
    print_out("{}: {} frames, {} grains, {} of {} contacts seen\n", command.out,
              experiment.recording.scans.size(), experiment.recording.diameter.size(), seen, real);
}

void add_unstated_errors(CLI::App& sub, Instrument& instrument) {
    const auto add = [&](const char* option, double& value, const char* unit, const CLI::Validator& check,
                         std::string_view help) {
        sub.add_option(option, value, fmt::format("Unstated error: {}", help))->type_name(unit)->check(check);
    };
    const auto effect = [](const char* name) { return find_effect(name)->formula; };
    const CLI::Range one(-1.0, 1.0), half(-0.5, 0.5);
    add("--force-bias", instrument.force_bias, "FRACTION", half, effect("force_bias"));
    add("--threshold-shift", instrument.threshold_shift, "N", one,
        "the true force threshold is higher by this [N]");
    add("--position-bias", instrument.position_bias, "FRACTION", CLI::Range(-0.05, 0.05),
        effect("position_bias"));
    add("--strain-offset", instrument.strain_offset, "M", one,
        "plate positions are measured too high by this [m]");
    add("--gauge-drift", instrument.gauge_drift, "FRACTION", half, effect("gauge_drift"));
    add("--zero-drift", instrument.zero_drift, "FRACTION", half, effect("zero_drift"));
    add("--gauge-hysteresis", instrument.gauge_hysteresis, "FRACTION", half, effect("gauge_hysteresis"));
    add("--force-lag", instrument.force_lag, "M", at_least_zero(), effect("force_lag"));
    add("--guide-friction", instrument.guide_friction, "FRACTION", CLI::Range(0.0, 0.5),
        effect("guide_friction"));
    add("--force-saturation", instrument.force_saturation, "PER_N", at_least_zero(),
        effect("force_saturation"));
}

}  // namespace

void add_measurement_options(CLI::App& command, Measurement& measurement) {
    const auto add = [&](const char* option, double& value, const char* unit, const char* help,
                         const CLI::Validator& check = at_least_zero()) {
        command.add_option(option, value, help)->type_name(unit)->check(check);
    };
    add("--position-error", measurement.position_error, "M",
        "Standard error of each coordinate of a centre [m]");
    add("--diameter-error", measurement.diameter_error, "M", "Standard error of a diameter [m]");
    add("--force-error", measurement.force_error, "FRACTION", "Relative standard error of a contact force",
        CLI::Range(0.0, 1.0));
    add("--force-threshold", measurement.force_threshold, "N",
        "Contacts below this force are not measured [N]");
}

void add_experiment_from_run(CLI::App& experiment) {
    auto* sub =
        experiment.add_subcommand("from-run", "Write a simulation as an experiment with measurement errors");
    auto command = std::make_shared<FromRunCommand>();
    sub->add_option("RUN", command->run, "Result folder or file")->required();
    sub->add_option("--out", command->out, "Folder to create")->required()->type_name("DIR");
    sub->add_option("--replica", command->replica,
                    "Label or number (from 0) of the replica; required if the run has several")
        ->type_name("REPLICA");
    sub->add_option("--name", command->name,
                    "Name of the experiment (default: that of the run and the replica)")
        ->type_name("TEXT");
    add_measurement_options(*sub, command->instrument.stated);
    add_unstated_errors(*sub, command->instrument);
    sub->add_option("--uncertainty", command->uncertainty,
                    "Stated standard error of a material parameter, such as grains.youngs_modulus=500")
        ->type_name("KEY=SIGMA")
        ->allow_extra_args(false);
    sub->add_option("--seed", command->seed, "Seed of the noise");
    sub->add_flag("--gzip", command->gzip, "Compress the tables with gzip");
    sub->footer(
        "Materials are stated as in the run; its effects are not. Unstated errors act on the data but are "
        "not\n"
        "written to experiment.toml, so that a diagnosis has to find them.\n"
        "Examples:\n"
        "  mcdem run scenes/small.toml --out out/begun --set protocol.scan_at_start=true\n"
        "  mcdem experiment from-run out/begun --replica mc_dem --out out/measured");
    sub->callback([command] { make_experiment(*command); });
}

}  // namespace mcdem::cli
