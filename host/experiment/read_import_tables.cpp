// The files of a mapping, or others in their place.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/errors.h"
#include "experiment/import_experiment.h"

namespace mcdem {
namespace {

/// How many columns the mapping names in this table, where the file has all of them; -1 where it lacks one.
long columns_in(const MappedTable& map, const ForeignTable& part) {
    long count = 0;
    for (const MappingKey& key : mapping_keys(map.role)) {
        const Guess* guess = map.find(key.name);
        if (!guess || key.kind == MappingKey::Kind::word || key.kind == MappingKey::Kind::number) continue;
        for (const std::string& word : guess->words) {
            if (key.name == "partner" && parse<Wall>(word)) continue;
            if (!part.find(signed_column(word).name)) return -1;
            ++count;
        }
    }
    return count;
}

/// Each file to the table that it fits best; two of the same merit are a problem.
void distribute(const std::vector<std::string>& files, std::vector<ImportTable>& tables,
                std::vector<std::string>& problems) {
    for (const std::string& file : files) {
        ImportTable* best = nullptr;
        std::optional<ForeignTable> part;
        long most = 0;
        std::string why =
            fmt::format("{}: must have the columns of a table of the mapping, got others", file);
        for (ImportTable& table : tables) {
            if (table.map.role == Role::aside) continue;
            try {
                ForeignTable read = read_foreign_table(file, table.map.form);
                const long columns = columns_in(table.map, read);
                if (columns == most && best)
                    why = fmt::format(
                        "{}: must fit one table of the mapping, got two that it fits: name the files in the "
                        "mapping",
                        file),
                    best = nullptr;
                if (columns <= most) continue;
                most = columns;
                best = &table;
                part = std::move(read);
            } catch (const InputError& error) {
                if (!best) why = error.what();
            }
        }
        if (!best) {
            problems.push_back(why);
            continue;
        }
        best->parts.push_back(std::make_shared<const ForeignTable>(std::move(*part)));
        best->map.files.push_back(file);
    }
}

}  // namespace

std::vector<ImportTable> read_import_tables(const Mapping& mapping, const std::vector<std::string>& files) {
    std::vector<ImportTable> tables;
    std::vector<std::string> problems;
    for (const MappedTable& map : mapping.tables) {
        ImportTable& table = tables.emplace_back(ImportTable{map, {}});
        if (!files.empty()) table.map.files.clear();
        if (map.role == Role::aside) continue;
        for (const std::string& file : table.map.files) try {
                table.parts.push_back(
                    std::make_shared<const ForeignTable>(read_foreign_table(file, map.form)));
            } catch (const InputError& error) {
                problems.insert(problems.end(), error.problems().begin(), error.problems().end());
            }
    }
    if (!files.empty()) {
        distribute(files, tables, problems);
        for (std::size_t t = 0; problems.empty() && t < tables.size(); ++t)
            if (tables[t].map.role != Role::aside && tables[t].map.files.empty())
                problems.push_back(
                    fmt::format("{}:{}: the table of {}, {} there, must have a file too, got none among "
                                "those given: give "
                                "it, or remove the table from the mapping",
                                mapping.file, mapping.tables[t].line, name(tables[t].map.role),
                                mapping.tables[t].files.front()));
        std::erase_if(tables, [](const ImportTable& table) { return table.map.files.empty(); });
    }
    if (!problems.empty()) throw InputError(problems);
    return tables;
}

}  // namespace mcdem
