// Which frames of the tables belong together.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiment/column_names.h"
#include "experiment/guess.h"

namespace mcdem {
namespace {

/// The frames of a table, and what their numbers count.
struct Frames {
    std::vector<double> keys;
    KeyedBy by = KeyedBy::place;
    std::string counts;  ///< "time", "step", "scan"; empty: nothing says
    std::string unit;    ///< of time, as its name states it
};

std::string quantity(const std::string& base) {
    const std::pair<std::string_view, std::string_view> words[] = {
        {" time t zeit temps ", "time"},
        {" step timestep schritt iter ", "step"},
        {" frame scan image snapshot bild state ", "scan"}};
    for (const auto& [names, what] : words)
        if (is_among(base, names)) return std::string(what);
    return "";
}

Frames frames_of(const ImportTable& table) {
    ExperimentProblems ignored;
    const Rows rows(table, ignored);
    Frames frames{{}, rows.keyed_by(), "", ""};
    const bool by_row = table.map.role == Role::plate && !rows.keyed();
    for (const RowAt& row : rows.all())
        if (by_row || frames.keys.empty() || frames.keys.back() != row.key)
            frames.keys.push_back(by_row ? static_cast<double>(frames.keys.size()) : row.key);
    const ColumnName name = column_name(table.map.word("frame", ""));
    if (frames.by == KeyedBy::column)
        frames.counts = quantity(name.base), frames.unit = name.unit + name.unknown;
    if (frames.by == KeyedBy::step) frames.counts = "step";
    if (by_row) frames.by = KeyedBy::place;
    return frames;
}

bool all_among(const std::vector<double>& keys, const std::vector<double>& others) {
    const FrameIndex index(others);
    return !keys.empty() && !others.empty() &&
           std::ranges::all_of(keys, [&](double key) { return index.find(key) >= 0; });
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

/// 0, 1, 2, .. or 1, 2, 3, ..: it may be the frames at hand that are counted, not those of others.
bool only_counts(const std::vector<double>& keys) {
    for (std::size_t i = 1; i < keys.size(); ++i)
        if (keys[i] != keys[i - 1] + 1) return false;
    return !keys.empty() && (keys.front() == 0 || keys.front() == 1);
}

std::string told_by(const Frames& frames) {
    const std::string unit = frames.unit.empty() ? "" : fmt::format(" [{}]", frames.unit);
    if (frames.by == KeyedBy::place) return "places in a list";
    if (frames.by == KeyedBy::file) return "numbers in file names";
    return frames.counts.empty() ? "numbers" : frames.counts + " numbers" + unit;
}

/// Times count from the same units: stated ones are converted. Beside seconds a name may state none.
bool same_clock(const Frames& a, const Frames& b) {
    if (a.unit == b.unit) return true;
    const bool near = 2 * a.keys.size() >= b.keys.size();
    if (a.unit.empty() || b.unit.empty()) return near && time_factor(a.unit.empty() ? b.unit : a.unit) == 1;
    return std::isfinite(time_factor(a.unit)) && std::isfinite(time_factor(b.unit));
}

/// How sure it is that frames whose numbers are all among those of `others` are the ones with these numbers.
Sure same_numbers(const Frames& frames, const Frames& others) {
    if (!same_clock(frames, others)) return Sure::unclear;
    const bool alike = frames.counts == others.counts;
    if (alike && frames.by == others.by) return frames.by == KeyedBy::place ? Sure::likely : Sure::sure;
    if (frames.keys.size() == others.keys.size()) return Sure::likely;
    if (others.by == KeyedBy::place)  // numbers of rows, if these count from 0 as well
        return frames.by != KeyedBy::file && frames.counts != "time" && frames.keys.front() == 0
                   ? Sure::likely
                   : Sure::unclear;
    if (frames.by == KeyedBy::file)
        return others.counts != "time" && !only_counts(frames.keys) ? Sure::likely : Sure::unclear;
    return alike || (frames.counts.empty() && others.counts != "time") ? Sure::likely : Sure::unclear;
}

Guess by_numbers(const std::string& word, const Frames& frames, const Frames& others,
                 const std::string& whose) {
    const Sure sure = same_numbers(frames, others);
    if (sure != Sure::unclear) return guess(word, sure, fmt::format("{} table has all of them", whose));
    return guess(word, sure,
                 fmt::format("{} here, {} there: are they the same?", told_by(frames), told_by(others)));
}

Guess in_order(const Frames& frames, const Frames& plate) {
    if (frames.keys.size() == plate.keys.size())
        return guess("order", Sure::likely,
                     fmt::format("there are {} of them, as many as rows of the plate", frames.keys.size()));
    return guess("order", Sure::unclear,
                 fmt::format("there are {} frames here and {} rows of the plate, and {} do not tell which "
                             "belong together",
                             frames.keys.size(), plate.keys.size(), told_by(frames)));
}

void match(ImportTable& table, const Frames& plate, const Frames* grains) {
    const Frames frames = frames_of(table);
    auto& entry = table.map.entries["frames_by"];
    const bool places = frames.by == KeyedBy::place;
    if (grains && places && grains->by == KeyedBy::place && frames.keys == grains->keys)
        entry = guess("grains", Sure::likely, "there are as many as of the grains");
    else if (places)
        entry = in_order(frames, plate);
    else if (const bool like_grains = grains && grains->by != KeyedBy::place &&
                                      (grains->by == KeyedBy::file) == (frames.by == KeyedBy::file) &&
                                      all_among(frames.keys, grains->keys);
             like_grains && (frames.keys.size() > 1 || !all_among(frames.keys, plate.keys)))
        entry = by_numbers("grains", frames, *grains, "the grains'");
    else if (all_among(frames.keys, plate.keys))
        entry = by_numbers("plate", frames, plate, "the plate's");
    else
        entry = in_order(frames, plate);
}

Frames joined(const std::vector<ImportTable>& tables) {
    Frames all;
    for (const ImportTable& table : tables) {
        if (table.map.role != Role::grains) continue;
        const Frames frames = frames_of(table);
        const std::vector<double> before = std::move(all.keys);
        all = frames;
        all.keys.insert(all.keys.begin(), before.begin(), before.end());
    }
    return all;
}

}  // namespace

void guess_frames(std::vector<ImportTable>& tables) {
    const auto plate =
        std::ranges::find(tables, Role::plate, [](const ImportTable& table) { return table.map.role; });
    if (plate == tables.end()) return;
    const Frames of_plate = frames_of(*plate);
    for (const Role role : {Role::grains, Role::contacts}) {
        const Frames grains = joined(tables);
        const bool beside = role == Role::contacts && !grains.keys.empty();
        for (ImportTable& table : tables)
            if (table.map.role == role) {
                choose_frame_column(table, *plate);
                match(table, of_plate, beside ? &grains : nullptr);
            }
    }
}

}  // namespace mcdem
