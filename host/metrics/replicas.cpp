#include "metrics/replicas.h"

#include <charconv>
#include <set>

namespace mcdem {
namespace {

// The scene keys that metrics know by name.
const std::string seed_key = "packing.seed";
const std::string model_key = "contact.model";
const std::string discard_key = "protocol.discard";

using Parameters = std::map<std::string, std::string>;

std::string value_of(const Parameters& parameters, const std::string& key) {
    const auto found = parameters.find(key);
    return found == parameters.end() ? "" : found->second;
}

/// TOML writes words in quotes; parameters may hold them either way.
std::string without_quotes(const std::string& text) {
    const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
    return quoted ? text.substr(1, text.size() - 2) : text;
}

Parameters without_seed(Parameters parameters) {
    parameters.erase(seed_key);
    return parameters;
}

/// Keys whose value is not the same in all settings.
std::set<std::string> keys_that_vary(const std::vector<Parameters>& settings) {
    std::set<std::string> all, varying;
    for (const auto& parameters : settings)
        for (const auto& [key, value] : parameters) all.insert(key);
    for (const auto& key : all)
        for (const auto& parameters : settings)
            if (value_of(parameters, key) != value_of(settings.front(), key)) varying.insert(key);
    return varying;
}

std::string label_of(const Parameters& parameters, const std::set<std::string>& varying) {
    std::string label = varying.contains(model_key) ? without_quotes(value_of(parameters, model_key)) : "";
    for (const auto& key : varying) {
        if (key == model_key) continue;
        const auto value = without_quotes(value_of(parameters, key));
        label += (label.empty() ? "" : ", ") + key.substr(key.rfind('.') + 1) + " = " +
                 (value.empty() ? "none" : value);
    }
    return label;
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
    for (std::size_t s = 0; s < settings.size(); ++s) {
        settings[s].label = label_of(parameters[s], varying);
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

}  // namespace mcdem
