#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "experiment/column_names.h"
#include "experiment/guess.h"

namespace mcdem {
namespace {

using Found = std::map<std::string, std::vector<std::string>, std::less<>>;  ///< columns by key

Found columns_by_key(Role role, const std::vector<std::string>& columns) {
    Found found;
    for (const std::string& column : columns)
        if (const auto key = key_of_name(role, column_name(column)))
            found[std::string(*key)].push_back(column);
    return found;
}

bool has(const Found& found, std::initializer_list<std::string_view> keys) {
    return std::ranges::all_of(keys, [&](auto key) { return found.contains(key); });
}

std::optional<Role> role_of(const std::vector<std::string>& columns) {
    const Found contacts = columns_by_key(Role::contacts, columns),
                grains = columns_by_key(Role::grains, columns), plate = columns_by_key(Role::plate, columns);
    if (has(contacts, {"grain", "partner"}) &&
        (has(contacts, {"fx", "fy", "fz"}) || has(contacts, {"force"})))
        return Role::contacts;
    if (has(grains, {"x", "y", "z"}) && (has(grains, {"diameter"}) || has(grains, {"radius"})))
        return Role::grains;
    if (has(plate, {"top_force"}) && (has(plate, {"plate_z"}) || has(plate, {"displacement"})))
        return Role::plate;
    return std::nullopt;
}

bool is_length(std::string_view key) {
    return key == "x" || key == "y" || key == "z" || key == "diameter" || key == "radius" ||
           key == "plate_z" || key == "displacement";
}
bool is_force(std::string_view key) {
    return key == "fx" || key == "fy" || key == "fz" || key == "force" || key == "top_force";
}

/// The unit that the names of these columns state, if they agree and it is one of `known`.
void note_unit(MappedTable& map, const std::string& key, bool (*belongs)(std::string_view),
               double (*factor)(std::string_view), std::string_view known) {
    std::set<std::string> units, others;
    for (const auto& [entry, guess] : map.entries) {
        if (!belongs(entry)) continue;
        const ColumnName name = column_name(guess.word());
        if (std::isfinite(factor(name.unit)))
            units.insert(name.unit);
        else if (!name.unit.empty() || !name.unknown.empty())
            others.insert(name.unit + name.unknown);
    }
    const std::string first = units.empty() ? std::string(known.substr(0, known.find(' '))) : *units.begin();
    if (!others.empty())
        map.entries[key] = guess(
            first, Sure::unclear,
            fmt::format("a name says [{}], which is none of {}: change the table", *others.begin(), known));
    else if (units.size() == 1)
        map.entries[key] = guess(first, Sure::sure, "the columns' names say so");
    else if (units.size() > 1)
        map.entries[key] =
            guess(first, Sure::unclear,
                  "the columns' names say different units, and a table has one: change the table");
}

/// A size of the normal force beside a tangential one, whose direction nothing tells.
void note_tangential(MappedTable& map, const std::vector<std::string>& columns) {
    for (const std::string& column : columns) {
        const std::string base = column_name(column).base;
        const bool tangential = base.starts_with("ft") || base.starts_with("fs") ||
                                base.find("tang") != base.npos || base.find("shear") != base.npos ||
                                base.find("scher") != base.npos;
        if (!tangential) continue;
        Guess& force = map.entries["force"];
        force.sure = Sure::unclear;
        force.why = fmt::format(
            "{} would be left aside: give fx, fy, fz, or confirm that the normal part is enough", column);
    }
}

}  // namespace

void guess_by_names(ImportTable& table) {
    MappedTable& map = table.map;
    const auto& columns = table.parts.front()->columns;
    const auto role = role_of(columns);
    map.role = role.value_or(Role::aside);
    map.role_sure = role ? Sure::sure : Sure::unclear;
    map.role_why = role ? "its columns are named so" : "its columns say nothing that is known";
    if (!role) return;
    Found found = columns_by_key(*role, columns);
    if (found.contains("displacement") && found.contains("plate_z")) found.erase("displacement");
    if (found.contains("diameter") && found.contains("radius")) found.erase("radius");
    if (has(found, {"fx", "fy", "fz"})) found.erase("force");
    if (*role == Role::contacts && !has(found, {"x", "y", "z"}))
        for (const char* key : {"x", "y", "z"}) found.erase(key);
    for (const auto& [key, names] : found) {
        // "time" beside "frame" is another way to say the same.
        const bool one = names.size() == 1 || key == "frame";
        map.entries[key] = guess(names.front(), one ? Sure::sure : Sure::unclear,
                                 one ? "its name" : fmt::format("{} columns have such a name", names.size()));
    }
    if (map.has("force")) note_tangential(map, columns);
    note_unit(map, "length_unit", is_length, length_factor, length_words);
    note_unit(map, "force_unit", is_force, force_factor, force_words);
}

}  // namespace mcdem
