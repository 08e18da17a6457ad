#include "cli/run/report_sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "core/input_file.h"
#include "core/look.h"
#include "core/sha256.h"
#include "io/result_folder.h"
#include "report/diagnosis/diagnosis_json.h"
#include "report/page/labels.h"

namespace mcdem::inline cli {
namespace {

std::string digest_of(const std::filesystem::path& file) {
    Sha256 digest;
    read_blocks(file, [&](std::string_view block) { digest.add(block); });
    return digest.hex();
}

/// The displayed replica of a setting: the first one, its index in its run, and the size of a scan.
struct Chosen {
    const Recording* recording;
    std::size_t run = 0, replica = 0;
    std::string label;
    long numbers = 0;
};

std::vector<Chosen> chosen_replicas(const LoadedRuns& loaded, const PackingLimits& limits) {
    std::vector<Chosen> chosen;
    for (const auto& setting : loaded.settings) {
        Chosen one{setting.replicas.front(), 0, 0, words_for(setting.label), 0};
        const auto holds = [&](const Run& run) {
            return one.recording >= run.recordings.data() &&
                   one.recording < run.recordings.data() + run.recordings.size();
        };
        while (!holds(loaded.runs[one.run])) ++one.run;
        one.replica = static_cast<std::size_t>(one.recording - loaded.runs[one.run].recordings.data());
        std::size_t contacts = 0;
        for (const auto& scan : one.recording->scans) contacts = std::max(contacts, scan.contacts.size());
        const auto grains = static_cast<long>(one.recording->diameter.size());
        const auto shown = std::min(grains, static_cast<long>(limits.max_grains));
        one.numbers = numbers_of_scan(shown, static_cast<long>(contacts) * shown / std::max(1L, grains));
        chosen.push_back(std::move(one));
    }
    return chosen;
}

/// Description of the parts of the packing that are not displayed; empty if all is.
std::string words_left_out(const Chosen& chosen, std::size_t scans, int max_grains) {
    const auto all_scans = chosen.recording->scans.size(), all_grains = chosen.recording->diameter.size();
    std::string words;
    if (scans < all_scans)
        words = fmt::format("{} of {} scans, evenly spread (--scans shows more)", scans, all_scans);
    if (all_grains > static_cast<std::size_t>(max_grains))
        words += fmt::format("{}the {} grains of {} nearest to the middle plane", words.empty() ? "" : ", ",
                             max_grains, all_grains);
    return words;
}

/// A note for each incomplete packing, or a common note if it is the same for all.
std::vector<std::string> notes_of(const std::vector<std::pair<std::string, std::string>>& left_out) {
    const auto as_first = [&](const auto& one) { return one.second == left_out.front().second; };
    std::vector<std::string> notes;
    if (left_out.size() > 1 && std::all_of(left_out.begin(), left_out.end(), as_first))
        return left_out.front().second.empty()
                   ? notes
                   : std::vector{"Shown of every packing: " + left_out.front().second + "."};
    for (const auto& [label, words] : left_out)
        if (!words.empty()) notes.push_back("Shown of " + label + ": " + words + ".");
    return notes;
}

}  // namespace

std::optional<std::filesystem::path> diagnosis_file(const std::filesystem::path& path) {
    if (path.extension() == ".json") return path;
    if (is_there(path / "diagnosis.json")) return path / "diagnosis.json";
    return std::nullopt;
}

Diagnosis read_diagnosis(const std::filesystem::path& file) {
    return diagnosis_of_json(read_file(file), file.string());
}

std::vector<RunOrigin> origins_of(const std::vector<std::string>& paths, const LoadedRuns& loaded) {
    std::vector<RunOrigin> origins;
    for (std::size_t k = 0; k < paths.size(); ++k) {
        RunOrigin origin{paths[k], &loaded.runs[k], {}};
        for (const auto& file : result_files(paths[k]))
            origin.digests.emplace_back(file.filename().string(), digest_of(file));
        origins.push_back(std::move(origin));
    }
    return origins;
}

void add_packings(const std::vector<std::string>& paths, const LoadedRuns& loaded, RunsOnPage& runs) {
    const auto chosen = chosen_replicas(loaded, runs.limits);
    long numbers = 0;
    for (const auto& one : chosen) numbers += one.numbers;
    std::vector<std::pair<std::string, std::string>> left_out;
    std::vector<std::unique_ptr<RunReader>> readers;
    for (const auto& path : paths) readers.push_back(std::make_unique<RunReader>(path));
    for (const auto& one : chosen) {
        auto& reader = *readers[one.run];
        const auto& known = reader.run().recordings.at(one.replica);
        ShownPacking packing{one.label, known};
        packing.recording.scans.clear();
        for (const auto scan : scans_shown(*one.recording, numbers, runs.limits))
            packing.recording.scans.push_back(reader.read_scan(one.replica, scan));
        const bool seen =
            !packing.recording.scans.empty() && !packing.recording.scans.front().position.empty();
        if (seen)
            left_out.emplace_back(
                one.label, words_left_out(one, packing.recording.scans.size(), runs.limits.max_grains));
        runs.packings.push_back(std::move(packing));
    }
    runs.left_out = notes_of(left_out);
}

}  // namespace mcdem::cli
