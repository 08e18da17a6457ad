#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "experiment/column_names.h"
#include "experiment/import_tables.h"
#include "scene/packing_fields.h"

namespace mcdem {

namespace {

/// The last number in a file's name, its endings left aside: 3 of "scan2/grains_003.csv.gz".
std::optional<double> number_in_name(const std::string& file) {
    std::string name = std::filesystem::path(file).filename().string();
    if (name.ends_with(".gz")) name.resize(name.size() - 3);
    name = std::filesystem::path(name).stem().string();
    constexpr std::string_view digits = "0123456789";
    const auto last = name.find_last_of(digits);
    if (last == name.npos) return std::nullopt;
    const auto before = name.find_last_not_of(digits, last);
    const auto first = before == name.npos ? 0 : before + 1;
    return to_number(name.substr(first, last + 1 - first));
}

/// The files' numbers where all have one and they rise; else their places.
std::vector<double> keys_of_files(const std::vector<const ForeignTable*>& parts, KeyedBy& by) {
    std::vector<double> places, numbers;
    for (const ForeignTable* part : parts) {
        places.push_back(static_cast<double>(places.size()));
        const auto number = number_in_name(part->file);
        if (number && (numbers.empty() || *number > numbers.back())) numbers.push_back(*number);
    }
    const bool numbered = parts.size() > 1 && numbers.size() == parts.size();
    by = numbered ? KeyedBy::file : KeyedBy::place;
    return numbered ? numbers : places;
}

}  // namespace

Rows::Rows(const ImportTable& table, ExperimentProblems& problems, std::size_t most) : problems_(problems) {
    for (const auto& part : table.parts) parts_.push_back(part.get());
    const long before = problems.count();
    find_columns(table);
    if (problems.count() > before) return;
    const bool has_key = has_column("frame");
    const std::vector<double> keys = keys_of_files(parts_, keyed_by_);
    const double time = time_factor(column_name(table.map.word("frame", "")).unit),
                 unit = std::isfinite(time) ? time : 1;
    if (has_key) keyed_by_ = KeyedBy::column;
    for (std::size_t p = 0; p < parts_.size(); ++p) {
        const ForeignTable& part = *parts_[p];
        if (!has_key && !part.frames.empty()) keyed_by_ = KeyedBy::step;
        std::size_t frame = 0;
        for (std::size_t r = 0; r < std::min(part.rows(), most); ++r) {
            RowAt row{&part, r, p, keys[p]};
            while (frame + 1 < part.frames.size() && part.frames[frame + 1].first_row <= r) ++frame;
            if (!part.frames.empty()) row.key = static_cast<double>(part.frames[frame].step);
            if (has_key) {
                const auto key = number(row, "frame");
                if (!key) continue;
                row.key = unit * *key;
            }
            rows_.push_back(row);
        }
    }
}

void Rows::find_columns(const ImportTable& table) {
    for (const MappingKey& key : mapping_keys(table.map.role)) {
        const Guess* guess = table.map.find(key.name);
        if (!guess || key.kind == MappingKey::Kind::word || key.kind == MappingKey::Kind::number) continue;
        if (key.name == "partner" && parse<Wall>(guess->word())) continue;
        auto& of_parts = columns_[std::string(key.name)];
        for (const ForeignTable* part : parts_) {
            auto& found = of_parts.emplace_back();
            for (const std::string& word : guess->words) {
                const auto [sign, name] = signed_column(word);
                const auto column = part->find(name);
                found.push_back({sign, column.value_or(0)});
                if (!column)
                    problems_.add(part->file,
                                  fmt::format("must have the column {} that the mapping names for {}, got {}",
                                              mcdem::quoted(name), key.name, fmt::join(part->columns, ", ")));
            }
        }
    }
}

std::optional<double> Rows::number(const RowAt& row, std::string_view key) const {
    const auto found = columns_.find(key);
    if (found == columns_.end()) return std::nullopt;
    double sum = 0;
    for (const auto& [sign, column] : found->second[row.part_index]) {
        const auto value = row.part->number(row.row, column);
        if (!value) {
            problem(row,
                    fmt::format(
                        "{} must be a finite number, got {}: leave the row out where nothing was measured",
                        row.part->columns[column], mcdem::quoted(row.part->cell(row.row, column))));
            return std::nullopt;
        }
        sum += sign * *value;
    }
    return sum;
}

std::optional<long> Rows::whole_number(const RowAt& row, std::string_view key) const {
    const auto value = number(row, key);
    if (!value) return std::nullopt;
    if (std::abs(*value) <= 2e9 && *value == std::round(*value)) return static_cast<long>(*value);
    problem(row, fmt::format("{} must be a whole number, got {}", key, *value));
    return std::nullopt;
}

std::size_t Rows::column_of(const RowAt& row, std::string_view key) const {
    return columns_.find(key)->second[row.part_index].front().index;
}

std::string_view Rows::text(const RowAt& row, std::string_view key) const {
    return row.part->cell(row.row, column_of(row, key));
}

double number_entry(const MappedTable& map, std::string_view key) {
    return to_number(map.word(key, "0")).value_or(0);
}

long whole_entry(const MappedTable& map, std::string_view key, ExperimentProblems& problems) {
    const auto number = to_number(map.word(key, "0"));
    if (number && std::abs(*number) <= 2e9 && *number == std::round(*number))
        return static_cast<long>(*number);
    problems.add(map.files.front(),
                 fmt::format("{} must be a whole number of at most 2e9, got \"{}\": see the mapping", key,
                             map.word(key, "0")));
    return 0;
}

void add_problem(ExperimentProblems& problems, const RowAt& row, const std::string& what) {
    problems.add(problems.full() ? row.part->file : row.part->where(row.row), what);
}

void add_problem_once(ExperimentProblems& problems, const std::string& topic, const RowAt& row,
                      const std::string& what) {
    const std::string name = row.part->file + topic;
    if (!problems.was_told(name)) problems.add_once(name, row.part->where(row.row), what);
}

FrameIndex::FrameIndex(const std::vector<double>& keys) {
    for (std::size_t i = 0; i < keys.size(); ++i) sorted_.emplace_back(keys[i], static_cast<int>(i));
    std::ranges::sort(sorted_);
    double shortest = INFINITY;
    for (std::size_t i = 1; i < sorted_.size(); ++i)
        if (const double step = sorted_[i].first - sorted_[i - 1].first; step > 0)
            shortest = std::min(shortest, step);
    tolerance_ = std::isfinite(shortest) ? 1e-3 * shortest
                 : sorted_.empty()       ? 0
                                         : 1e-9 * std::abs(sorted_.front().first);
}

int FrameIndex::find(double key) const {
    const auto next = std::ranges::lower_bound(sorted_, key - tolerance_, {}, &std::pair<double, int>::first);
    return next != sorted_.end() && next->first <= key + tolerance_ ? next->second : -1;
}

}  // namespace mcdem
