// Summary of the available data.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/container.h"
#include "experiment/findings.h"
#include "scene/programme/programme_text.h"

namespace mcdem::inline experiment {
namespace {

void describe_plate(const Recording& recording, Findings& findings) {
    const auto& scans = recording.scans;
    const auto loading = std::ranges::count(scans, Phase::load, &Scan::phase);
    const auto [low, high] = std::ranges::minmax_element(scans, {}, &Scan::plate_z);
    const auto [weak, strong] = std::ranges::minmax_element(scans, {}, &Scan::top_force);
    findings.note(plate_file,
                  "frames: {} of loading, {} of unloading, cycles {} to {}; plate at {:.6g} to {:.6g} m, "
                  "displacements {:.4g} to {:.4g} mm; top force {:.4g} to {:.4g} N",
                  loading, static_cast<long>(scans.size()) - loading, scans.front().cycle, scans.back().cycle,
                  high->plate_z, low->plate_z, 1e3 * recording.displacement(*high),
                  1e3 * recording.displacement(*low), weak->top_force(), strong->top_force());
}

void describe_programme(const Recording& recording, Findings& findings) {
    const auto programme = programme_of(recording.parameters);
    if (programme.empty()) return;
    std::map<Controlled, std::vector<std::string>> holds;
    for (const Stage& stage : programme)
        if (stage.kind == StageKind::hold) holds[stage.keep].push_back(fmt::format("{:.4g}", stage.time));
    std::string text = fmt::format("a programme of {} stages in {:.4g} s", programme.size(),
                                   recording.scans.back().time - recording.scans.front().time);
    for (const auto& [keep, times] : holds)
        text += fmt::format("; {} held for {} s, which shows {}", name(keep), fmt::join(times, ", "),
                            keep == Controlled::force ? "creep" : "relaxation");
    findings.note(plate_file, "{}", text);
}

void describe_grains(const Recording& recording, Findings& findings) {
    if (recording.diameter.empty()) return;
    const auto frames =
        std::ranges::count_if(recording.scans, [](const Scan& scan) { return !scan.position.empty(); });
    const auto [smallest, largest] = std::ranges::minmax_element(recording.diameter);
    findings.note(grains_file, "{} grains of {:.4g} to {:.4g} mm, {:.4g} mm on average, in {} of {} frames",
                  recording.diameter.size(), 1e3 * *smallest, 1e3 * *largest, 1e3 * mean_diameter(recording),
                  frames, recording.scans.size());
}

void describe_contacts(const Recording& recording, Findings& findings) {
    std::size_t frames = 0, contacts = 0;
    std::set<Wall> walls;
    for (const Scan& scan : recording.scans) {
        frames += !scan.contacts.empty();
        contacts += scan.contacts.size();
        for (const Contact& contact : scan.contacts)
            if (is_wall(contact.partner)) walls.insert(wall_of(contact.partner));
    }
    if (frames == 0) return;
    std::vector<std::string_view> names;
    for (const Wall wall : walls) names.push_back(wall_name(recording.box, wall));
    findings.note(contacts_file, "{} contacts in {} of {} frames, between grains and with {}", contacts,
                  frames, recording.scans.size(),
                  names.empty() ? "no wall" : fmt::format("{}", fmt::join(names, ", ")));
    findings.note(contacts_file,
                  "each contact is listed once, so it cannot be checked that both sides agree");
}

void describe_settings(const Experiment& experiment, Findings& findings) {
    const Measurement& errors = experiment.measurement;
    findings.note(settings_file,
                  "{}; errors of {:.3g} mm in positions, {:.3g} mm in diameters, {:.3g} % in forces; "
                  "contacts seen from {:.3g} mN on",
                  container_words(experiment.recording.box), 1e3 * errors.position_error,
                  1e3 * errors.diameter_error, 100 * errors.force_error, 1e3 * errors.force_threshold);
    std::vector<std::string> known;
    for (const auto& [key, value] : experiment.materials) {
        const auto sigma = experiment.uncertainty.find(key);
        known.push_back(fmt::format("{} = {:.6g}", key, value));
        if (sigma != experiment.uncertainty.end()) known.back() += fmt::format(" +- {:.3g}", sigma->second);
    }
    if (!known.empty()) findings.note(settings_file, "{}", fmt::join(known, ", "));
}

}  // namespace

void describe(const Experiment& experiment, Findings& findings) {
    describe_plate(experiment.recording, findings);
    describe_programme(experiment.recording, findings);
    describe_grains(experiment.recording, findings);
    describe_contacts(experiment.recording, findings);
    describe_settings(experiment, findings);
}

}  // namespace mcdem::experiment
