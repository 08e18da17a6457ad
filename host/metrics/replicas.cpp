#include "metrics/replicas.h"

#include <algorithm>
#include <charconv>

#include "core/parameters.h"

namespace mcdem::inline metrics {
namespace {

// Scene keys used by the metrics.
const std::string seed_key = "packing.seed";
const std::string model_key = "contact.model";
const std::string discard_key = "protocol.discard";

Parameters without_seed(Parameters parameters) {
    parameters.erase(seed_key);
    return parameters;
}

/// "gamma=1" for every key that varies; the model comes first.
std::string label_of(const Parameters& parameters, const std::vector<std::string>& varying) {
    std::string label =
        std::ranges::count(varying, model_key) ? without_quotes(value_of(parameters, model_key)) : "";
    for (const auto& key : varying) {
        if (key == model_key) continue;
        const auto value = without_quotes(value_of(parameters, key));
        label += (label.empty() ? "" : ", ") + key.substr(key.rfind('.') + 1) + "=" +
                 (value.empty() ? "none" : value);
    }
    return label;
}

/// Common label of all recordings without the number of the copy " #2"; empty if labels differ.
std::string common_label(const Replicas& replicas) {
    const auto without_copy = [](const std::string& label) {
        const auto end = label.find_last_not_of("0123456789");
        const bool is_copy =
            end != label.npos && end > 0 && end + 1 < label.size() && label.compare(end - 1, 2, " #") == 0;
        return is_copy ? label.substr(0, end - 1) : label;
    };
    const std::string label = without_copy(replicas.front()->label);
    for (const auto* recording : replicas)
        if (recording->parameters.empty() || without_copy(recording->label) != label) return "";
    return label;
}

/// Labels from the scene, if they distinguish all settings.
std::vector<std::string> labels_of_scene(const std::vector<Setting>& settings) {
    std::vector<std::string> labels;
    for (const auto& setting : settings) {
        labels.push_back(common_label(setting.replicas));
        if (labels.back().empty() || std::ranges::count(labels, labels.back()) > 1) return {};
    }
    return labels;
}

}  // namespace

Replicas replicas_of(const std::vector<Recording>& recordings) {
    Replicas replicas;
    for (const auto& recording : recordings) replicas.push_back(&recording);
    return replicas;
}

std::vector<Setting> group_by_setting(const Run& run) {
    std::vector<Parameters> parameters;
    std::vector<Setting> settings;
    for (const auto& recording : run.recordings) {
        const auto mine = without_seed(recording.parameters);
        std::size_t which = 0;
        while (which < parameters.size() && parameters[which] != mine) ++which;
        if (which == parameters.size()) {
            parameters.push_back(mine);
            settings.emplace_back();
        }
        settings[which].replicas.push_back(&recording);
    }
    const auto varying = keys_that_vary(parameters);
    const auto labels = labels_of_scene(settings);
    for (std::size_t s = 0; s < settings.size(); ++s) {
        settings[s].label = labels.empty() ? label_of(parameters[s], varying) : labels[s];
        if (settings[s].label.empty()) settings[s].label = without_quotes(value_of(parameters[s], model_key));
        if (settings[s].label.empty()) settings[s].label = run.name;
    }
    return settings;
}

std::string seed_of(const Recording& recording) { return value_of(recording.parameters, seed_key); }

std::vector<std::string> seeds_of(const Replicas& replicas) {
    std::vector<std::string> seeds;
    for (const auto* recording : replicas) seeds.push_back(seed_of(*recording));
    return seeds;
}

std::optional<ContactModel> model_of(const Replicas& replicas) {
    std::optional<ContactModel> model;
    for (const auto* recording : replicas) {
        const auto mine = parse<ContactModel>(without_quotes(value_of(recording->parameters, model_key)));
        if (!mine || (model && *model != *mine)) return std::nullopt;
        model = mine;
    }
    return model;
}

int discard_of(const Recording& recording) {
    const auto text = value_of(recording.parameters, discard_key);
    int discard = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), discard);
    return error == std::errc{} && discard > 0 ? discard : 0;
}

bool follows_programme(const Recording& recording) { return has_programme(recording.parameters); }

}  // namespace mcdem::metrics
