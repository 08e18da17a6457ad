#include <fmt/format.h>
#include <string.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "experiment/column_names.h"
#include "experiment/guess.h"

namespace mcdem {
namespace {

std::vector<ForeignTable> read_all(const std::vector<std::string>& files) {
    std::vector<ForeignTable> parts;
    std::vector<std::string> problems;
    for (const std::string& file : files) try {
            parts.push_back(read_foreign_table(file));
        } catch (const InputError& error) {
            problems.insert(problems.end(), error.problems().begin(), error.problems().end());
        }
    if (!problems.empty()) throw InputError(problems);
    return parts;
}

/// Files with the same columns are the frames of one table, in the order of the numbers in their names.
std::vector<ImportTable> group(std::vector<ForeignTable> parts) {
    std::vector<ImportTable> tables;
    for (ForeignTable& part : parts) {
        const auto alike = std::ranges::find_if(tables, [&](const ImportTable& table) {
            const ForeignTable& first = *table.parts.front();
            return part.named && first.named && first.columns == part.columns &&
                   first.format == part.format && first.form == part.form;
        });
        ImportTable& table = alike == tables.end() ? tables.emplace_back() : *alike;
        table.parts.push_back(std::make_shared<const ForeignTable>(std::move(part)));
    }
    for (ImportTable& table : tables) {
        std::ranges::stable_sort(table.parts, [](const auto& a, const auto& b) {
            if (!a->frames.empty() && !b->frames.empty())
                return a->frames.front().step < b->frames.front().step;
            return strverscmp(a->file.c_str(), b->file.c_str()) < 0;
        });
        for (const auto& part : table.parts) table.map.files.push_back(part->file);
        if (table.parts.front()->format == TableFormat::text) table.map.form = table.parts.front()->form;
    }
    return tables;
}

/// The frame keys of a table, in their order.
std::vector<double> keys_of(const ImportTable& table) {
    ExperimentProblems ignored;
    const Rows rows(table, ignored);
    std::vector<double> keys;
    for (const RowAt& row : rows.all())
        if (keys.empty() || keys.back() != row.key) keys.push_back(row.key);
    return keys;
}

bool all_among(const std::vector<double>& keys, const std::vector<double>& others) {
    const FrameIndex index(others);
    return !others.empty() && std::ranges::all_of(keys, [&](double key) { return index.find(key) >= 0; });
}

/// Of several columns that may tell the frame, the one that the plate's table has too.
void choose_frame_column(ImportTable& table, const ImportTable& plate) {
    const Guess* of_plate = plate.map.find("frame");
    if (!of_plate || !table.map.has("frame")) return;
    const std::string base = column_name(of_plate->word()).base;
    for (const std::string& column : table.parts.front()->columns)
        if (column_name(column).base == base && key_of_name(table.map.role, column_name(column)) == "frame")
            table.map.entries["frame"] = guess(column, Sure::sure, "the plate's table has it too");
}

void match(ImportTable& table, const std::vector<double>& plate, bool plate_counts,
           const std::vector<double>* grains) {
    const std::vector<double> keys = keys_of(table);
    auto& entry = table.map.entries["frames_by"];
    if (keys.size() > 1 && grains && all_among(keys, *grains))
        entry = guess("grains", Sure::sure, "the grains' table has all of them");
    else if (all_among(keys, plate))
        entry = guess("plate", plate_counts ? Sure::likely : Sure::sure,
                      plate_counts ? "they count the plate's rows" : "the plate's table has all of them");
    else if (grains && all_among(keys, *grains))
        entry = guess("grains", Sure::sure, "the grains' table has all of them");
    else if (keys.size() == plate.size())
        entry = guess("order", Sure::likely,
                      fmt::format("there are {} of them, as many as rows of the plate", keys.size()));
    else
        entry =
            guess("order", Sure::unclear,
                  fmt::format(
                      "there are {} frames here and {} rows of the plate, and their numbers or times differ",
                      keys.size(), plate.size()));
}

}  // namespace

void guess_frames(std::vector<ImportTable>& tables) {
    const auto plate =
        std::ranges::find(tables, Role::plate, [](const ImportTable& table) { return table.map.role; });
    if (plate == tables.end()) return;
    ExperimentProblems ignored;
    const Rows rows(*plate, ignored);
    std::vector<double> plate_keys;
    for (const RowAt& row : rows.all())
        plate_keys.push_back(rows.keyed() ? row.key : static_cast<double>(plate_keys.size()));
    std::vector<double> grain_keys;
    for (ImportTable& table : tables)
        if (table.map.role == Role::grains) {
            choose_frame_column(table, *plate);
            match(table, plate_keys, !rows.keyed(), nullptr);
            const auto keys = keys_of(table);
            grain_keys.insert(grain_keys.end(), keys.begin(), keys.end());
        }
    for (ImportTable& table : tables)
        if (table.map.role == Role::contacts) {
            choose_frame_column(table, *plate);
            match(table, plate_keys, !rows.keyed(), grain_keys.empty() ? nullptr : &grain_keys);
        }
}

std::vector<ImportTable> guess_tables(const std::vector<std::string>& files, const Experiment& known) {
    std::vector<ImportTable> tables = group(read_all(files));
    for (ImportTable& table : tables) {
        guess_by_names(table);
        if (table.map.role == Role::aside) guess_grains_by_values(table);
    }
    for (ImportTable& table : tables)
        if (table.map.role == Role::grains) guess_grain_lengths(table, known);
    guess_frames(tables);
    const GrainFrames grains = grains_so_far(tables);
    for (ImportTable& table : tables) {
        if (table.map.role == Role::aside) guess_contacts_by_values(table, grains);
        if (table.map.role == Role::contacts) guess_contact_meaning(table, grains, known);
    }
    const bool has_plate =
        std::ranges::any_of(tables, [](const ImportTable& table) { return table.map.role == Role::plate; });
    for (ImportTable& table : tables) {
        if (table.map.role == Role::aside && !has_plate) guess_plate_by_values(table);
        if (table.map.role == Role::plate) guess_plate_units(table, tables, grains, known);
    }
    guess_frames(tables);
    for (ImportTable& table : tables) table.map.aside = left_aside(table.map, table.parts.front()->columns);
    return tables;
}

}  // namespace mcdem
