#include "scene/programme/programme_text.h"

#include <fmt/format.h>

#include "core/errors.h"
#include "core/parameters.h"
#include "scene/read/list_tables.h"
#include "scene/read/toml_text.h"

namespace mcdem::inline scene {
namespace {

/// Parses a TOML value; other text is a word.
toml::table value_of_text(const std::string& text) {
    return parse_value(text).value_or(toml::table{{"value", without_quotes(text)}});
}

/// Assigns a value from the text that the table of keys has written.
void assign_text(const Key& key, const std::string& text, Settings& settings) {
    if (text.empty()) return;  // not given
    const toml::table table = value_of_text(text);
    assign(key, *table.get("value"), settings);
}

/// Checks stages from a file that may have been written by others.
void expect_legs(const std::vector<Stage>& programme) {
    int before = 0;
    for (const Stage& stage : programme)
        if (const int number = before++; stage.kind == StageKind::repeat && stage.stages > number)
            throw InputError(fmt::format(
                "programme.{}.stages: must be at most the {} stages before it, got {}: the parameters are "
                "damaged",
                number + 1, number, stage.stages));
    if (leg_count(programme) > max_legs || scan_count(programme) > max_scans)
        throw InputError(fmt::format(
            "programme: must have at most {} moves and holds and {} scans: the parameters are damaged",
            max_legs, max_scans));
}

}  // namespace

std::map<std::string, std::string> programme_parameters(const std::vector<Stage>& programme) {
    Settings settings;
    settings.replica.programme = programme;
    std::map<std::string, std::string> all;
    for (std::size_t n = 0; n < programme.size(); ++n)
        for (const Key& key : stage_keys(static_cast<int>(n)))
            all[std::string(key.name)] = value_text(key, settings);
    return all;
}

std::vector<Stage> programme_of(const std::map<std::string, std::string>& parameters) {
    Settings settings;
    for (int n = 0; n < max_stages && parameters.contains(std::string(stage_keys(n).front().name)); ++n) {
        settings.replica.programme.emplace_back();
        for (const Key& key : stage_keys(n))
            assign_text(key, value_of(parameters, std::string(key.name)), settings);
    }
    expect_legs(settings.replica.programme);
    return settings.replica.programme;
}

toml::array programme_tables(const std::vector<Stage>& programme) {
    toml::array tables;
    for (const Stage& stage : programme) {
        Settings settings, defaults;
        settings.replica.programme = {stage};
        defaults.replica.programme = {{}};
        toml::table table;
        for (const Key& key : stage_keys(0)) {
            const std::string text = value_text(key, settings);
            if (text == value_text(key, defaults) || text.empty()) continue;
            const toml::table value = value_of_text(text);
            value.get("value")->visit([&](const auto& concrete) {
                table.insert(key.name.substr(key.name.rfind('.') + 1), concrete);
            });
        }
        tables.push_back(table);
    }
    return tables;
}

std::vector<ScanPlace> scan_places(const std::vector<Stage>& programme, const Plate& plate) {
    std::vector<ScanPlace> places;
    double position = plate.start, force = not_given;  // at the end of the previous leg
    const std::vector<Leg> legs = legs_of(programme, plate);
    for (std::size_t l = 0; l < legs.size(); ++l) {
        const Stage& stage = programme[legs[l].stage];
        const bool held = stage.kind == StageKind::hold, by_force = controlled(stage) == Controlled::force;
        const double from = by_force ? force : position;
        const double end = held ? stage.time : legs[l].target;
        for (int n = 1; n <= scans_of(stage); ++n) {
            const bool at_target = stage.scan_at.empty() && n == stage.scans;  // exactly
            const double at = held        ? scan_time(stage, n)
                              : at_target ? end
                                          : scan_level(stage, n, from, end, plate);
            places.push_back({legs[l].stage, static_cast<int>(l), held, at == end, controlled(stage),
                              held ? from : at, held ? at : 0});
        }
        if (!held) (by_force ? force : position) = end;
        (by_force ? position : force) = not_given;
    }
    return places;
}

}  // namespace mcdem::scene
