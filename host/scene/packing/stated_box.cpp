#include "scene/packing/stated_box.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/container.h"
#include "scene/packing/packing_fields.h"

namespace mcdem::inline scene {
namespace {

using Face = StatedBox::Face;
constexpr char axis_name[] = "xyz";

/// LIGGGHTS writes bounds with six digits (%g). Each is right to half a unit of its last digit, 5e-6 of the
/// number; a length is the difference of two, and the scene's value is rounded as well.
double length_rounding(const StatedBox& box, int axis) {
    return 1e-5 * std::max({std::abs(box.low[axis]), std::abs(box.high()[axis]), box.size[axis]});
}

std::optional<Vec3> vector_of(const std::vector<std::string_view>& words, std::size_t first = 0) {
    Vec3 vector;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto number = first + axis < words.size() ? to_number(words[first + axis]) : std::nullopt;
        if (!number) return std::nullopt;
        vector[static_cast<int>(axis)] = *number;
    }
    return vector;
}

/// Box of three edge vectors. Nothing, and a problem, if the first is not along x or the second leaves the
/// plane of x and y.
std::optional<StatedBox> box_of_edges(const std::array<Vec3, 4>& edges, long line, FileProblems& problems) {
    const auto& [a, b, c, origin] = edges;
    const double small = 1e-5 * std::max({a.norm(), b.norm(), c.norm()});
    const bool aligned = std::max({std::abs(a.y()), std::abs(a.z()), std::abs(b.z())}) <= small;
    if (!aligned || !(a.x() > 0 && b.y() > 0 && c.z() > 0)) {
        problems.add(line, fmt::format("the box must have its first edge along x and its second in the plane "
                                       "of x and y, got {:.6g}, {:.6g}, {:.6g} and {:.6g}, {:.6g}, {:.6g}: "
                                       "turn it so, with its grains, and write it again",
                                       a.x(), a.y(), a.z(), b.x(), b.y(), b.z()));
        return std::nullopt;
    }
    StatedBox box;
    box.low = origin;
    box.size = {a.x(), b.y(), c.z()};
    box.tilt_xy = b.x(), box.tilt_xz = c.x(), box.tilt_yz = c.y();
    return box;
}

/// The upright bounds of a box whose lines give those of its corners.
void remove_tilts(StatedBox& box, Vec3 low, Vec3 high) {
    const double xy = box.tilt_xy, xz = box.tilt_xz, yz = box.tilt_yz;
    low.x() -= std::min({0.0, xy, xz, xy + xz}), high.x() -= std::max({0.0, xy, xz, xy + xz});
    low.y() -= std::min(0.0, yz), high.y() -= std::max(0.0, yz);
    box.low = low, box.size = high - low;
}

Face face_of(char letter) {
    return letter == 'p' ? Face::periodic : letter == 'f' ? Face::fixed : Face::moving;
}

/// Boundaries such as "pp fs mm"; other words are ignored, as in old files without any.
void read_faces(const std::vector<std::string_view>& words, StatedBox& box) {
    std::size_t axis = 0;
    for (const std::string_view word : words)
        if (word.size() == 2 && axis < 3 && word.find_first_not_of("pfsm") == word.npos) {
            box.face[2 * axis] = face_of(word[0]);
            box.face[2 * axis + 1] = face_of(word[1]);
            ++axis;
        }
}

}  // namespace

std::optional<StatedBox> dump_box(std::string_view title, const std::vector<std::string_view>& rows,
                                  long line, const std::string& source, FileProblems& problems) {
    std::vector<std::string_view> words;
    split_at_blanks(title, words);
    const auto has = [&](std::string_view word) { return std::ranges::find(words, word) != words.end(); };
    const bool general = has("abc"), tilted = has("xy");
    const std::size_t columns = general ? 4 : tilted ? 3 : 2;
    std::array<Vec3, 4> edges;
    edges.fill(Vec3::Zero());
    StatedBox box;
    Vec3 low, high;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::vector<std::string_view> cells;
        if (axis < rows.size()) split_at_blanks(rows[axis], cells);
        std::vector<double> numbers;
        for (const std::string_view cell : cells)
            if (const auto number = to_number(cell)) numbers.push_back(*number);
        const int k = static_cast<int>(axis);
        if (cells.size() != columns || numbers.size() != columns ||
            (!general && !(numbers[0] <= numbers[1]))) {
            problems.add(line + k, fmt::format("the bounds along {} must be {} numbers{}, got {}",
                                               axis_name[k], columns, general ? "" : ", the lower one first",
                                               axis < rows.size() ? quoted(rows[axis]) : "the file's end"));
            return std::nullopt;
        }
        if (general) {
            edges[axis] = {numbers[0], numbers[1], numbers[2]};
            edges[3][k] = numbers[3];
            continue;
        }
        low[k] = numbers[0], high[k] = numbers[1];
        if (tilted) (axis == 0 ? box.tilt_xy : axis == 1 ? box.tilt_xz : box.tilt_yz) = numbers[2];
    }
    if (general) {
        const auto found = box_of_edges(edges, line, problems);
        if (!found) return std::nullopt;
        box = *found;
    } else {
        remove_tilts(box, low, high);
    }
    read_faces(words, box);
    box.where = fmt::format("{}:{}", source, line);
    return box;
}

bool DataBox::read(const std::vector<std::string_view>& words, long line, FileProblems& problems) {
    const auto is = [&](std::size_t place, std::string_view word) {
        return words.size() > place && words[place] == word;
    };
    const auto expect = [&](bool good) {
        if (line_ == 0) line_ = line;
        if (!good)
            problems.add(line,
                         fmt::format("a line of the box must hold finite numbers, the lower bound first, "
                                     "got {}",
                                     scene::quoted(fmt::format("{}", fmt::join(words, " ")))));
        return true;
    };
    constexpr std::string_view edge_names[] = {"avec", "bvec", "cvec"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (is(2, std::string(1, axis_name[axis]) + "lo") && words.size() == 4) {
            const auto low = to_number(words[0]), high = to_number(words[1]);
            const bool good = low && high && *low <= *high;
            if (good) bounds_[axis] = {*low, *high};
            return expect(good);
        }
        if (is(3, edge_names[axis])) {
            edges_[axis] = vector_of(words);
            return expect(edges_[axis].has_value());
        }
    }
    if (is(3, "abc") && is(4, "origin")) {
        edges_[3] = vector_of(words);
        return expect(edges_[3].has_value());
    }
    if (!is(3, "xy") || !is(4, "xz") || !is(5, "yz")) return false;
    const auto tilts = vector_of(words);
    if (tilts) tilts_ = {tilts->x(), tilts->y(), tilts->z()};
    return expect(tilts.has_value());
}

std::optional<StatedBox> DataBox::box(const std::string& source, FileProblems& problems) const {
    const auto has = [](const auto& value) { return value.has_value(); };
    StatedBox box;
    if (std::ranges::all_of(edges_, has)) {
        const auto found = box_of_edges({*edges_[0], *edges_[1], *edges_[2], *edges_[3]}, line_, problems);
        if (!found) return std::nullopt;
        box = *found;
    } else if (std::ranges::all_of(bounds_, has)) {
        for (int axis = 0; axis < 3; ++axis) {
            const auto [low, high] = *bounds_[static_cast<std::size_t>(axis)];
            box.low[axis] = low, box.size[axis] = high - low;
        }
        box.tilt_xy = tilts_[0], box.tilt_xz = tilts_[1], box.tilt_yz = tilts_[2];
    } else {
        return std::nullopt;
    }
    box.where = fmt::format("{}:{}", source, line_);
    return box;
}

namespace {

class BoxComparison {
public:
    BoxComparison(const Packing& packing, const StatedBox& box, const Box& container)
        : packing_(packing), box_(box), container_(container) {}

    BoxFindings compare() {
        if (box_.shape && *box_.shape != container_.shape) {
            problem(
                fmt::format("must be of the scene's container.shape = \"{}\", got a {}: set "
                            "container.shape = \"{}\"",
                            name(container_.shape), name(*box_.shape), name(*box_.shape)));
            return found_;
        }
        if (is_tilted()) {
            problem(
                fmt::format("must be upright, as the scene's container is, got one with xy = {:.6g}, xz = "
                            "{:.6g}, yz = {:.6g} m: take the packing of an upright box{}",
                            box_.tilt_xy, box_.tilt_xz, box_.tilt_yz,
                            is_cell(container_) ? ", and shear it by a [[programme]]" : ""));
            return found_;
        }
        for (int axis = 0; axis < 3; ++axis) {
            if (axis == 2 ? is_cell(container_) : is_periodic(container_))
                compare_period(axis);
            else
                compare_walls(axis);
        }
        return found_;
    }

private:
    void problem(const std::string& what) { found_.problems.push_back(box_.where + ": the box " + what); }

    /// A tilt by whole periods gives the same images as an upright cell.
    bool is_tilted() const {
        const Vec3 size = box_.size;
        double xy = box_.tilt_xy, xz = box_.tilt_xz, yz = box_.tilt_yz;
        if (is_cell(container_)) {
            xz -= std::nearbyint(yz / size.y()) * xy;
            xz = std::remainder(xz, size.x()), yz = std::remainder(yz, size.y());
        }
        if (is_periodic(container_)) xy = std::remainder(xy, size.x());
        return std::max(std::abs(xy), std::abs(xz)) > length_rounding(box_, 0) ||
               std::abs(yz) > length_rounding(box_, 1);
    }

    double length(int axis) const {
        return axis == 0 ? container_.size_x : axis == 1 ? container_.size_y : container_.height;
    }
    std::string key(int axis) const {
        if (is_cylinder(container_) && axis < 2) return "container.radius";
        return axis == 2 ? "container.height" : fmt::format("container.size_{}", axis_name[axis]);
    }
    Face face(int axis, int side) const { return box_.face[static_cast<std::size_t>(2 * axis + side)]; }
    bool differs(int axis) const {
        return !(std::abs(box_.size[axis] - length(axis)) <= length_rounding(box_, axis));
    }

    void compare_period(int axis) {
        const char along = axis_name[axis];
        if (face(axis, 0) != Face::unknown && face(axis, 0) != Face::periodic)
            return problem(
                fmt::format("must repeat along {} as the scene's container.shape = \"{}\", got "
                            "boundaries that do not: set container.shape = \"{}\"",
                            along, name(container_.shape), axis == 2 ? "periodic" : "box"));
        if (differs(axis))
            problem(
                fmt::format("must be {} m long along {}, the period of the scene, got {:.9g}: set {} = "
                            "{:.9g}",
                            length(axis), along, box_.size[axis], key(axis), box_.size[axis]));
    }

    /// Between walls, or between floor and plate.
    void compare_walls(int axis) {
        if (box_.shape) return compare_walls_of_run(axis);
        if (face(axis, 0) == Face::periodic && grains_reach_through(axis))
            return problem(
                fmt::format("must not repeat along {}, where the scene has walls and grains reach "
                            "through its face: contacts there would be lost; set container.shape "
                            "= \"{}\"",
                            axis_name[axis], axis == 2 ? "cell" : "periodic"));
        const double low = box_.low[axis], high = box_.high()[axis], small = length_rounding(box_, axis);
        const bool from = low > small, to = axis < 2 && high < length(axis) - small;
        const auto cuts = [&](Face kind) {
            return (from && face(axis, 0) == kind) || (to && face(axis, 1) == kind);
        };
        if (!cuts(Face::unknown) && !cuts(Face::fixed) && !cuts(Face::periodic)) return;
        const std::string range = axis == 2 ? "the floor at z = 0"
                                            : fmt::format("the scene's container, 0 to {} m along {}",
                                                          length(axis), axis_name[axis]);
        const std::string remedy =
            from ? fmt::format("move the grains by {:.6g} m along {}", -low, axis_name[axis])
                 : fmt::format("set {} = {:.9g}", key(axis), is_cylinder(container_) ? high / 2 : high);
        const std::string text =
            fmt::format("must hold {}, got {:.6g} to {:.6g} m: {}", range, low, high, remedy);
        if (cuts(Face::unknown))
            found_.warnings.push_back(fmt::format("{}: the box of the file should hold {}", box_.where,
                                                  text.substr(std::string_view("must hold ").size())));
        else
            problem(text);
    }

    void compare_walls_of_run(int axis) {
        if (axis == 2 || !differs(axis)) return;
        const double part = is_cylinder(container_) ? 0.5 : 1;
        if (axis == 1 && is_cylinder(container_)) return;
        problem(fmt::format("must be that of the scene, {} = {}, got {:.9g}: set {} = {:.9g}", key(axis),
                            part * length(axis), part * box_.size[axis], key(axis), part * box_.size[axis]));
    }

    bool grains_reach_through(int axis) const {
        const double small = length_rounding(box_, axis);
        for (std::size_t i = 0; i < packing_.size(); ++i) {
            const double at = packing_.position[i][axis], radius = packing_.diameter[i] / 2;
            if (at - radius < box_.low[axis] - small || at + radius > box_.high()[axis] + small) return true;
        }
        return false;
    }

    const Packing& packing_;
    const StatedBox& box_;
    const Box& container_;
    BoxFindings found_;
};

}  // namespace

BoxFindings compare_box(const Packing& packing, const std::optional<StatedBox>& box, const Box& container) {
    if (!box) return {};
    return BoxComparison(packing, *box, container).compare();
}

}  // namespace mcdem::scene
