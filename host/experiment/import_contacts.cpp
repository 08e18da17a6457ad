#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "experiment/findings.h"
#include "experiment/import_tables.h"

namespace mcdem {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// The wall that pushes a grain with this force: straight off it, friction left aside.
Wall wall_by_direction(const Vec3& force) {
    int axis = 0;
    force.cwiseAbs().maxCoeff(&axis);
    return static_cast<Wall>(2 * axis + (force[axis] > 0 ? 0 : 1));
}

class ContactImporter {
public:
    ContactImporter(const ImportTable& table, const GrainFrames& grains, ExperimentProblems& problems,
                    std::size_t most)
        : map_(table.map), rows_(table, problems, most), grains_(grains), problems_(problems) {
        length_ = length_factor(map_.word("length_unit", "m"));
        force_ =
            force_factor(map_.word("force_unit", "N")) * (map_.word("force_on", "grain") == "grain" ? 1 : -1);
        offset_ = whole_entry(map_, "id_offset", problems);
        one_wall_ = parse<Wall>(map_.word("partner", ""));
        has_point_ = rows_.has_column("x") && rows_.has_column("y") && rows_.has_column("z");
        has_size_ = rows_.has_column("force");
    }

    ContactFrames read() {
        ContactFrames frames;
        std::set<double> used;
        if (!has_columns()) return frames;
        for (const RowAt& row : rows_.all()) {
            if (frames.keys.empty() || frames.keys.back() != row.key) {
                if (!used.insert(row.key).second)
                    rows_.problem_once(
                        "order", row,
                        fmt::format(
                            "the rows of frame {} must follow one another, got more behind others: sort them",
                            row.key));
                frames.keys.push_back(row.key);
                frames.contacts.emplace_back();
                at_ = centres(row.key, frames.keys.size() - 1);
            }
            // Behind the frame: one without contacts counts in the order too.
            if (rows_.has_column("where") && rows_.number(row, "where").value_or(0) == 0) continue;
            const auto contact = read_row(row);
            // Without any force grains are only near: LAMMPS lists them too.
            if (contact && !contact->force.isZero(0)) frames.contacts.back().push_back({*contact, row});
        }
        frames.index = FrameIndex(frames.keys);
        return frames;
    }

private:
    /// The grains' centres in the frame of contacts that has begun; null where they are not known.
    const std::vector<Vec3>* centres(double key, std::size_t place) const {
        const int frame = grains_.frame_of(map_.word("frames_by", "plate"), key, place);
        return frame < 0 ? nullptr : &grains_.position[static_cast<std::size_t>(frame)];
    }

    bool has_columns() {
        const long before = problems_.count();
        std::vector<const char*> needed{"grain"};
        if (!one_wall_) needed.push_back("partner");
        if (!has_size_) needed.insert(needed.end(), {"fx", "fy", "fz"});
        for (const char* key : needed)
            if (!rows_.has_column(key))
                problems_.add(
                    map_.files.front(),
                    fmt::format("must have a column for {}, got none: name it in the mapping", key));
        return problems_.count() == before;
    }

    int grain_of(long id) const {
        const auto found = grains_.number_of.find(id + offset_);
        return found == grains_.number_of.end() ? -1 : found->second;
    }

    /// A grain, or a wall that the force may still have to decide.
    struct Side {
        int grain = -1;
        std::optional<Wall> wall;
        bool by_force = false;
    };

    std::optional<Side> side_of(const RowAt& row, std::string_view key) const {
        if (key == "partner" && one_wall_) return Side{-1, one_wall_, false};
        const std::string_view text = rows_.text(row, key);
        const auto number = rows_.number_if_any(row, key);
        const bool whole = number && std::abs(*number) < 2e9 && *number == std::round(*number);
        const int grain = whole ? grain_of(static_cast<long>(*number)) : -1;
        const auto wall = map_.walls.find(number ? fmt::format("{}", *number) : std::string(text));
        // Meshes have numbers of their own, which may be those of grains too.
        if (wall != map_.walls.end() && (key == "partner" || grain < 0))
            return wall->second.word() == by_direction ? Side{-1, {}, true}
                                                       : Side{-1, parse<Wall>(wall->second.word()), false};
        if (const auto named = parse<Wall>(text)) {
            const int axis = static_cast<int>(*named) / 2;
            if (axis == 2 || grains_.sign[axis] > 0) return Side{-1, named, false};
            rows_.problem_once(
                std::string(text), row,
                fmt::format("{0} must be named in [table.walls] where {1} is turned round, {0} = "
                            "\"x_min\" or another",
                            text, "xyz"[axis]));
            return std::nullopt;
        }
        if (grain >= 0) return Side{grain, {}, false};
        rows_.problem(
            row, fmt::format("{} must be a grain, or a wall that [table.walls] of the mapping names, got {}",
                             key, quoted(text)));
        return std::nullopt;
    }

    std::optional<Contact> read_row(const RowAt& row) {
        auto first = side_of(row, "grain"), second = side_of(row, "partner");
        if (!first || !second) return std::nullopt;
        const bool turned = first->grain < 0;  // Yade lists walls first
        if (turned) std::swap(first, second);
        if (first->grain < 0 || first->grain == second->grain) {
            rows_.problem(
                row,
                fmt::format("a contact must have a grain and another, or a wall, got {} and {}",
                            quoted(rows_.text(row, "grain")),
                            one_wall_ ? std::string(name(*one_wall_)) : quoted(rows_.text(row, "partner"))));
            return std::nullopt;
        }
        Contact contact{first->grain, second->grain, Vec3::Constant(not_known), Vec3::Zero(), not_known};
        if (!read_force(row, *second, turned, contact)) return std::nullopt;
        if (second->wall || second->by_force)
            contact.partner = wall_partner(second->wall.value_or(wall_by_direction(contact.force)));
        if (has_point_) {
            const auto x = rows_.number(row, "x"), y = rows_.number(row, "y"), z = rows_.number(row, "z");
            if (!x || !y || !z) return std::nullopt;
            contact.point = length_ * Vec3(*x, *y, *z) - grains_.origin;
        }
        return contact;
    }

    bool read_force(const RowAt& row, const Side& partner, bool turned, Contact& contact) {
        if (!has_size_) {
            const auto x = rows_.number(row, "fx"), y = rows_.number(row, "fy"), z = rows_.number(row, "fz");
            if (!x || !y || !z) return false;
            contact.force = (turned ? -force_ : force_) * Vec3(*x, *y, *z);
            return true;
        }
        const auto size = rows_.number(row, "force");
        if (!size) return false;
        Vec3 away;  // from the partner
        if (partner.wall) {
            const int axis = static_cast<int>(*partner.wall) / 2;
            away = Vec3::Unit(axis) * (static_cast<int>(*partner.wall) % 2 == 0 ? 1 : -1);
        } else {
            if (!at_ || partner.by_force) {
                rows_.problem_once(
                    "size", row,
                    "a force's size needs to know its direction: both centres in this frame, or which wall");
                return false;
            }
            away = (at(*at_, contact.grain) - at(*at_, contact.partner)).normalized();
        }
        contact.force = std::abs(force_) * *size * away;
        return true;
    }

    const MappedTable& map_;
    Rows rows_;
    const GrainFrames& grains_;
    ExperimentProblems& problems_;
    const std::vector<Vec3>* at_ = nullptr;  ///< the grains of the frame being read
    double length_, force_;                  ///< SI in the table's units
    long offset_;
    std::optional<Wall> one_wall_;
    bool has_point_, has_size_;
};

}  // namespace

ContactFrames import_contacts(const ImportTable& table, const GrainFrames& grains,
                              ExperimentProblems& problems, std::size_t most) {
    return ContactImporter(table, grains, problems, most).read();
}

}  // namespace mcdem
