#include "experiment/import_mapping.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace mcdem {
namespace {

using Kind = MappingKey::Kind;
constexpr std::string_view lengths = length_words, forces = force_words;

// clang-format off
constexpr MappingKey plate_keys[] = {
    {"frame", Kind::column, "", "a row's frame number, time or step; without it the rows count"},
    {"cycle", Kind::column, "", "compression cycle, rising; without it from the plate's turns"},
    {"phase", Kind::column, "", "load or unload (down or up, compression or decompression); without it from the plate's direction"},
    {"plate_z", Kind::quantity, "", "height of the plate; this or displacement; with a - before its name where it counts downwards"},
    {"displacement", Kind::quantity, "", "how far the plate has gone down from plate.start; with a - where it counts upwards"},
    {"top_force", Kind::quantities, "", "force on the plate"},
    {"length_unit", Kind::word, lengths, ""},
    {"origin_z", Kind::number, "", "where the floor is, as plate_z's column counts; 0 where left out"},
    {"force_unit", Kind::word, forces, ""},
    {"force_sign", Kind::word, "+ -", "+: upward force on the plate is positive; -: negative"},
};
constexpr MappingKey grain_keys[] = {
    {"frame", Kind::column, "", "which rows belong together: frame number, time or step"},
    {"frames_by", Kind::word, "plate order", "plate: frames have the plate's numbers, times or steps; order: the first is the plate's first row, and so on"},
    {"grain", Kind::column, "", "a grain's number, alike in all frames; without it the rows of a frame count"},
    {"first_grain", Kind::number, "", "the number of the first row's grain, where no column has it"},
    {"x", Kind::quantity, "", "centre"},
    {"y", Kind::quantity, "", "centre"},
    {"z", Kind::quantity, "", "centre, upwards; with a - before its name where it counts downwards"},
    {"diameter", Kind::column, "", "this or radius"},
    {"radius", Kind::column, "", "this or diameter"},
    {"length_unit", Kind::word, lengths, ""},
    {"origin_x", Kind::number, "", "where the wall x_min stands, in the table's unit, as x's column counts"},
    {"origin_y", Kind::number, "", "where the wall y_min stands"},
    {"origin_z", Kind::number, "", "where the floor is"},
};
constexpr MappingKey contact_keys[] = {
    {"frame", Kind::column, "", "which rows belong together: frame number, time or step"},
    {"frames_by", Kind::word, "plate grains order", "whose frame numbers, times or steps these are; order: the plate's rows, one after the other"},
    {"grain", Kind::column, "", "the grain"},
    {"partner", Kind::column, "", "the other grain, or a wall; or one wall's name, where all rows are its"},
    {"where", Kind::column, "", "rows with 0 here are no contacts"},
    {"id_offset", Kind::number, "", "added to grain and partner gives the numbers of the grains' table"},
    {"x", Kind::quantity, "", "contact point; without it midway between the surfaces"},
    {"y", Kind::quantity, "", "contact point"},
    {"z", Kind::quantity, "", "contact point"},
    {"fx", Kind::quantities, "", "force; several columns are added up, such as normal and tangential parts, those with a - are taken off"},
    {"fy", Kind::quantities, "", "force"},
    {"fz", Kind::quantities, "", "force"},
    {"force", Kind::quantities, "", "in place of fx, fy, fz: size of a force along the line of centres, > 0 where it pushes"},
    {"force_on", Kind::word, "grain partner", "on which of the two the force is"},
    {"sides", Kind::word, "one both", "both: each contact is listed from either side, and the mean counts"},
    {"length_unit", Kind::word, lengths, "of contact points"},
    {"force_unit", Kind::word, forces, ""},
};
// clang-format on

double factor(std::string_view unit, std::span<const std::pair<std::string_view, double>> table) {
    for (const auto& [name, value] : table)
        if (name == unit) return value;
    return std::nan("");
}

}  // namespace

std::span<const MappingKey> mapping_keys(Role role) {
    switch (role) {
        case Role::plate:
            return plate_keys;
        case Role::grains:
            return grain_keys;
        case Role::contacts:
            return contact_keys;
        case Role::aside:
            return {};
    }
    return {};
}

const MappingKey* find_mapping_key(Role role, std::string_view name) {
    const auto keys = mapping_keys(role);
    const auto found = std::ranges::find(keys, name, &MappingKey::name);
    return found == keys.end() ? nullptr : &*found;
}

std::vector<std::string> left_aside(const MappedTable& map, const std::vector<std::string>& columns) {
    std::vector<std::string> aside;
    for (const std::string& column : columns) {
        const bool used = std::ranges::any_of(map.entries, [&](const auto& entry) {
            return std::ranges::any_of(entry.second.words, [&](const std::string& word) {
                return signed_column(word).name == column;
            });
        });
        if (!used) aside.push_back(column);
    }
    return aside;
}

std::vector<std::string_view> must_be_stated(const MappedTable& table) {
    const auto any = [&](std::initializer_list<std::string_view> keys) {
        return std::ranges::any_of(keys, [&](auto key) { return table.has(key); });
    };
    const bool contacts = table.role == Role::contacts;
    std::vector<std::string_view> keys;
    if (any({"plate_z", "displacement", "x", "y", "z", "diameter", "radius"})) keys.push_back("length_unit");
    if (any({"top_force", "force", "fx", "fy", "fz"})) keys.push_back("force_unit");
    if (table.role == Role::plate && any({"top_force"})) keys.push_back("force_sign");
    if (contacts && any({"fx", "fy", "fz"})) keys.push_back("force_on");
    return keys;
}

double length_factor(std::string_view unit) {
    constexpr std::array<std::pair<std::string_view, double>, 4> table{
        {{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}}};
    return factor(unit, table);
}

double force_factor(std::string_view unit) {
    constexpr std::array<std::pair<std::string_view, double>, 9> table{{{"N", 1},
                                                                        {"mN", 1e-3},
                                                                        {"uN", 1e-6},
                                                                        {"kN", 1e3},
                                                                        {"cN", 1e-2},
                                                                        {"daN", 10},
                                                                        {"gf", 9.80665e-3},
                                                                        {"kgf", 9.80665},
                                                                        {"lbf", 4.4482216152605}}};
    return factor(unit, table);
}

}  // namespace mcdem
