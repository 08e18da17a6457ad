#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/container.h"
#include "experiment/findings.h"
#include "experiment/measurements.h"

namespace mcdem::inline experiment {
namespace {

constexpr double max_change =
    0.25;  // relative change of a diameter between frames, larger than measurement errors

struct GrainRow {
    long grain;
    Vec3 position;    ///< [m]
    double diameter;  ///< [m]
    long line;
};

/// Collects the rows of one frame, and checks that all grains are there.
class Frames {
public:
    Frames(Table& table, Recording& recording) : table_(table), recording_(recording) {}

    void add(long frame, GrainRow row) {
        if (frame != frame_) {
            end_frame();
            frame_ = frame;
        }
        check(row);
        rows_.push_back(std::move(row));
    }

    void end_frame() {
        if (frame_ < 0) return;
        const std::size_t grains = recording_.diameter.empty() ? rows_.size() : recording_.diameter.size();
        std::vector<Vec3> position(grains, Vec3::Zero());
        std::vector<double> diameter(grains, 0.0);
        std::vector<bool> seen(grains, false);
        for (const GrainRow& row : rows_) place(row, grains, position, diameter, seen);
        const auto missing = std::ranges::find(seen, false);
        if (missing != seen.end())
            table_.problem_at(
                table_.where(rows_.front().line),
                fmt::format("frame {} must list all {} grains, but grain {} is missing: add it, or leave "
                            "the whole frame out",
                            frame_, grains, missing - seen.begin()));
        if (recording_.diameter.empty()) recording_.diameter = std::move(diameter);
        recording_.scans[frame_].position = std::move(position);
        rows_.clear();
    }

    long frame() const { return frame_; }

private:
    void check(const GrainRow& row) {
        check_diameter(row);
        const Box& box = recording_.box;
        const double plate_z = recording_.scans[frame_].plate_z;
        if (box.size_x > 0 && is_outside(box, plate_z, row.position))
            table_.problem_once(
                "position",
                fmt::format("centres must lie in the {} below the plate at {} m, got {}, {}, {} m: "
                            "divide by 1000 if they are in millimetres, shift them if the origin is "
                            "elsewhere, and check that frames are numbered consistently with plate.csv",
                            container_words(box), plate_z, row.position.x(), row.position.y(),
                            row.position.z()));
    }

    void check_diameter(const GrainRow& row) {
        const double width = std::max(recording_.box.size_x, recording_.box.size_y);
        const auto i = static_cast<std::size_t>(row.grain);
        const double first = i < recording_.diameter.size() ? recording_.diameter[i] : row.diameter;
        if (!(row.diameter > 0))
            table_.problem(fmt::format("diameter_m must be > 0 [m], got {}", row.diameter));
        else if (width > 0 && row.diameter > width)
            table_.problem_once(
                "diameter", fmt::format("diameter_m must be in metres: {} is more than the box's width of {} "
                                        "m; divide by 1000 if it is in millimetres",
                                        row.diameter, width));
        else if (std::abs(row.diameter - first) > max_change * first)
            table_.problem_once(
                "change",
                fmt::format("grain {} must be as large as in frame 0, {} m, got {}: number the grains "
                            "alike in all frames",
                            row.grain, first, row.diameter));
    }

    void place(const GrainRow& row, std::size_t grains, std::vector<Vec3>& position,
               std::vector<double>& diameter, std::vector<bool>& seen) {
        const auto i = static_cast<std::size_t>(row.grain);
        if (i >= grains)
            return table_.problem_at(
                table_.where(row.line),
                fmt::format("grain must be 0 to {}, got {}: grains count from 0, the same in "
                            "every frame",
                            grains - 1, row.grain));
        if (seen[i])
            return table_.problem_at(table_.where(row.line),
                                     fmt::format("grain {} is there twice in frame {}", row.grain, frame_));
        seen[i] = true;
        position[i] = near_the_last(i, row.position);
        diameter[i] = row.diameter;
    }

    static bool is_outside(const Box& box, double plate_z, const Vec3& point) {
        constexpr double drift = 20;  // of a grain in a periodic container, in its edges
        if (is_periodic(box) &&
            std::max(std::abs(point.x()) / box.size_x, std::abs(point.y()) / box.size_y) > drift)
            return true;
        return std::ranges::any_of(walls_of(box),
                                   [&](Wall wall) { return wall_distance(box, wall, plate_z, point) < 0; });
    }

    /// In a periodic container, the image nearest to the grain's previous position.
    Vec3 near_the_last(std::size_t grain, const Vec3& point) {
        if (!is_periodic(recording_.box)) return point;
        if (grain >= last_.size()) last_.resize(grain + 1, point);
        return last_[grain] += apart(recording_.box, last_[grain], point);
    }

    Table& table_;
    Recording& recording_;
    std::vector<Vec3> last_;  ///< by grain: its position in the frame before
    std::vector<GrainRow> rows_;
    long frame_ = -1;
};

}  // namespace

void read_grains(Table& table, Recording& recording) {
    Frames frames(table, recording);
    while (table.next()) {
        const auto frame = read_frame(table, recording, frames.frame());
        const auto grain = table.whole_number(1, 0);
        const auto x = table.number(2), y = table.number(3), z = table.number(4), diameter = table.number(5);
        if (!frame || !grain || !x || !y || !z || !diameter) continue;
        if (frames.frame() < 0 && *frame != 0)
            table.problem_once(
                "first",
                fmt::format("the first frame must be 0, which says what grains there are, got {}", *frame));
        frames.add(*frame, {*grain, Vec3(*x, *y, *z), *diameter, table.line()});
    }
    frames.end_frame();
}

}  // namespace mcdem::experiment
