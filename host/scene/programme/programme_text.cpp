#include "scene/programme/programme_text.h"

#include <fmt/format.h>

#include "core/errors.h"
#include "scene/read/list_tables.h"
#include "scene/read/toml_text.h"

namespace mcdem::inline scene {
namespace {

/// Appends the value to a list of TOML, if it is given.
struct ToToml {
    toml::array& list;
    void operator()(std::monostate) const {}
    void operator()(double value) const {
        if (is_written_whole(value))
            list.push_back(static_cast<std::int64_t>(value));
        else
            list.push_back(value);
    }
    void operator()(std::uint64_t value) const { list.push_back(static_cast<std::int64_t>(value)); }
    void operator()(const std::vector<double>& values) const {
        toml::array numbers;
        for (const double value : values) ToToml{numbers}(value);
        list.push_back(numbers);
    }
    template <class Value>
    void operator()(const Value& value) const {
        list.push_back(value);
    }
};

/// The value, or an empty list if it is not given.
toml::array toml_of(const Parameter& parameter) {
    toml::array list;
    std::visit(ToToml{list}, parameter);
    return list;
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

Parameters programme_parameters(const std::vector<Stage>& programme) {
    Settings settings;
    settings.replica.programme = programme;
    Parameters all;
    for (std::size_t n = 0; n < programme.size(); ++n)
        for (const Key& key : stage_keys(static_cast<int>(n)))
            all[std::string(key.name)] = value_of(key, settings);
    return all;
}

std::vector<Stage> programme_of(const Parameters& parameters) {
    Settings settings;
    for (int n = 0; n < max_stages && parameters.contains(std::string(stage_keys(n).front().name)); ++n) {
        settings.replica.programme.emplace_back();
        for (const Key& key : stage_keys(n)) {
            const toml::array value = toml_of(find_parameter(parameters, std::string(key.name)));
            if (!value.empty()) assign(key, value.front(), settings);
        }
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
            const Parameter parameter = value_of(key, settings);
            if (parameter == value_of(key, defaults)) continue;
            const toml::array value = toml_of(parameter);
            value.for_each([&](const auto& concrete) { table.insert(last_part(key.name), concrete); });
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
