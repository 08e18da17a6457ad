#include <fmt/format.h>
#include <string.h>

#include <algorithm>

#include "core/errors.h"
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
        if (std::ranges::none_of(table.parts, [](const auto& part) { return part->decimal_clear; }))
            table.map.decimal_unclear =
                "every comma has three digits behind it: if they part thousands, write the table without "
                "them";
    }
    return tables;
}

}  // namespace

std::vector<ImportTable> guess_tables(const std::vector<std::string>& files, const Experiment& known) {
    std::vector<ImportTable> tables = group(read_all(files));
    for (ImportTable& table : tables) {
        guess_by_names(table);
        if (table.map.role == Role::aside) guess_grains_by_values(table);
    }
    guess_grains_upwards(tables);
    for (ImportTable& table : tables)
        if (table.map.role == Role::grains) guess_grain_lengths(table, known);
    guess_frames(tables);
    GrainFrames grains = grains_so_far(tables);
    for (ImportTable& table : tables)
        if (table.map.role == Role::aside) guess_contacts_by_values(table, grains);
    const bool has_plate =
        std::ranges::any_of(tables, [](const ImportTable& table) { return table.map.role == Role::plate; });
    for (ImportTable& table : tables)
        if (table.map.role == Role::aside && !has_plate) guess_plate_by_values(table);
    guess_frames(tables);
    if (!has_plate) grains = grains_so_far(tables);
    for (ImportTable& table : tables)
        if (table.map.role == Role::contacts) guess_contact_meaning(table, grains, known);
    for (ImportTable& table : tables) {
        if (table.map.role == Role::plate) guess_plate_units(table, tables, grains, known);
        table.map.aside = left_aside(table.map, table.parts.front()->columns);
    }
    return tables;
}

}  // namespace mcdem
