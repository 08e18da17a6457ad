// Which of what contacts name are walls, and which walls.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiment/column_names.h"
#include "experiment/guess.h"

namespace mcdem {
namespace {

constexpr double near = 1.3;  // of a radius: at the wall, measurement errors included

std::string key_text(double number) { return fmt::format("{}", number); }

/// Empty, or a word for nothing: never a wall.
bool is_nothing(std::string_view cell) {
    std::string small;
    for (const char c : cell) small += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    for (const std::string_view word :
         {"", "-", "--", "?", "na", "n/a", "#n/a", "nan", "+nan", "-nan", "null", "none"})
        if (small == word) return true;
    return false;
}

/// Words for walls, in lower case; others are decided by direction.
std::string wall_word(const std::string& text, bool downwards) {
    const std::string base = column_name(text).base;
    const std::pair<std::string_view, std::string_view> words[] = {
        {" floor bottom boden base ", "floor"},
        {" plate top lid piston deckel platte stempel ", "plate"},
        {downwards ? " zmax zhi " : " zmin zlo ", "floor"},
        {downwards ? " zmin zlo " : " zmax zhi ", "plate"},
        {" xmin left links xlo ", "x_min"},
        {" xmax right rechts xhi ", "x_max"},
        {" ymin front vorn ylo ", "y_min"},
        {" ymax back rear hinten yhi ", "y_max"}};
    for (const auto& [names, wall] : words)
        if (is_among(base, names)) return std::string(wall);
    return std::string(by_direction);
}

/// The contacts of what the table calls a wall.
struct Touches {
    std::map<Wall, long> counts;  ///< by the way the force points
    long all = 0, at_wall = 0;    ///< of those whose grain has a place
};

bool is_at(Wall wall, const Vec3& centre, double radius, const Box& box, double top) {
    const int axis = static_cast<int>(wall) / 2;
    const double places[] = {0, box.size_x, 0, box.size_y, 0, top};
    return std::abs(centre[axis] - places[static_cast<int>(wall)]) < near * radius;
}

/// What a row calls its wall: in the partner's column, or in the grain's.
std::string name_in(const ContactFrames::One& one, const MappedTable& map) {
    for (const char* key : {"partner", "grain"}) {
        const auto column = one.row.part->find(map.word(key, ""));
        if (!column) continue;
        const auto number = one.row.part->number(one.row.row, *column);
        const std::string name =
            number ? key_text(*number) : std::string(one.row.part->cell(one.row.row, *column));
        if (map.walls.contains(name)) return name;
    }
    return "";
}

std::map<std::string, Touches> touches_of(const ImportTable& table, const ContactFrames& frames,
                                          const GrainFrames& grains, const Box& box) {
    std::map<std::string, Touches> touches;
    for (std::size_t f = 0; f < frames.contacts.size(); ++f) {
        const int frame = grains.frame_of(table.map.word("frames_by", "plate"), frames.keys[f], f);
        const double top = frame < 0 ? 0 : grains.top(static_cast<std::size_t>(frame));
        for (const ContactFrames::One& one : frames.contacts[f]) {
            if (!is_wall(one.contact.partner)) continue;
            Touches& of_name = touches[name_in(one, table.map)];
            const Wall wall = wall_of(one.contact.partner);
            ++of_name.counts[wall];
            if (frame < 0) continue;
            const auto grain = static_cast<std::size_t>(one.contact.grain);
            ++of_name.all;
            of_name.at_wall += is_at(wall, grains.position[static_cast<std::size_t>(frame)][grain],
                                     grains.diameter[grain] / 2, box, top);
        }
    }
    return touches;
}

void name_by_direction(Guess& wall, const Touches& touches) {
    long all = 0;
    for (const auto& [which, count] : touches.counts) all += count;
    const auto most =
        std::ranges::max_element(touches.counts, {}, [](const auto& count) { return count.second; });
    if (all > 0 && static_cast<double>(most->second) > 0.9 * static_cast<double>(all))
        wall = guess(std::string(name(most->first)), Sure::likely,
                     fmt::format("{} of its {} forces point away from there", most->second, all));
    else
        wall.why += "; its forces point several ways";
}

}  // namespace

std::set<std::string> strangers(const ImportTable& table, const GrainFrames& grains, long offset,
                                std::size_t most, std::string_view only) {
    std::set<std::string> found;
    for (const std::string_view key : {"grain", "partner"}) {
        const std::string name = table.map.word(key, "");
        if (parse<Wall>(name) || (!only.empty() && key != only)) continue;
        for (const auto& part : table.parts) {
            const auto column = part->find(name);
            for (std::size_t row = 0; column && row < std::min(part->rows(), most) && found.size() < 20;
                 ++row) {
                const auto number = part->number(row, *column);
                const std::string_view cell = part->cell(row, *column);
                if (!number && !parse<Wall>(cell) && !is_nothing(cell)) found.insert(std::string(cell));
                if (number && std::abs(*number) < 2e9 &&
                    (*number != std::round(*number) ||
                     !grains.number_of.contains(static_cast<long>(*number) + offset)))
                    found.insert(key_text(*number));
            }
        }
    }
    return found;
}

void set_walls(ImportTable& table, const std::set<std::string>& names, const GrainFrames& grains) {
    table.map.walls.clear();
    for (const std::string& name : names) {
        const std::string word = wall_word(name, grains.sign.z() < 0);
        table.map.walls[name] =
            guess(word, Sure::likely, word == by_direction ? "no grain has this number" : "its name");
    }
}

void guess_walls(ImportTable& table, const ContactFrames& frames, const GrainFrames& grains, const Box& box) {
    auto touches = touches_of(table, frames, grains, box);
    ExperimentProblems ignored;
    const long offset = whole_entry(table.map, "id_offset", ignored);
    const auto first = strangers(table, grains, offset, all_rows, "grain"),
               second = strangers(table, grains, offset, all_rows, "partner");
    for (auto& [name, wall] : table.map.walls) {
        const Touches& of_name = touches[name];
        const bool named = wall.word() != by_direction;
        if (!named) name_by_direction(wall, of_name);
        const bool away =
            box.size_x > 0 && static_cast<double>(of_name.at_wall) < 0.9 * static_cast<double>(of_name.all);
        if (away || (!named && (of_name.all == 0 || box.size_x <= 0))) {
            wall.sure = Sure::unclear;
            wall.why += fmt::format(
                "; {} of its {} contacts are of grains that are at that wall: is it a "
                "grain that is not in the grains' table?",
                of_name.at_wall, of_name.all);
        } else if (!named && first.contains(name) && !second.empty()) {
            wall.sure = Sure::unclear;
            wall.why += "; but it stands for a grain, and walls stand for partners";
        }
    }
}

}  // namespace mcdem
