#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <compare>
#include <limits>

#include "core/container.h"
#include "experiment/findings.h"
#include "experiment/measurements.h"
#include "scene/packing/packing_fields.h"

namespace mcdem::inline experiment {
namespace {

class ContactReader {
public:
    ContactReader(Table& table, double youngs_modulus, Recording& recording)
        : table_(table), recording_(recording) {
        const double diameter = *std::ranges::max_element(recording.diameter);
        largest_force_ = youngs_modulus * diameter * diameter;
        margin_ = Vec3::Constant(std::max(recording.box.size_x, recording.box.size_y) + diameter);
    }

    void read() {
        while (table_.next()) {
            const auto frame = read_frame(table_, recording_, frame_);
            const auto contact = read_contact();
            if (!frame || !contact) continue;
            if (*frame != frame_) end_frame();
            frame_ = *frame;
            recording_.scans[frame_].contacts.push_back(*contact);
            rows_.push_back({contact->grain, contact->partner, table_.line()});
        }
        end_frame();
    }

private:
    struct Row {
        int grain, partner;
        long line;
        auto operator<=>(const Row&) const = default;
    };

    void end_frame() {
        std::ranges::sort(rows_);
        for (std::size_t k = 1; k < rows_.size(); ++k)
            if (rows_[k].grain == rows_[k - 1].grain && rows_[k].partner == rows_[k - 1].partner)
                table_.problem_at(
                    table_.where(rows_[k].line),
                    fmt::format(
                        "this contact is there twice in frame {}, first in line {}: list each pair once",
                        frame_, rows_[k - 1].line));
        rows_.clear();
    }

    std::optional<int> read_grain(std::size_t column) {
        const auto grain = table_.whole_number(column, 0);
        if (!grain) return std::nullopt;
        const long grains = static_cast<long>(recording_.diameter.size());
        if (*grain < grains) return static_cast<int>(*grain);
        table_.problem(
            fmt::format("{} must be a grain of grains.csv, 0 to {}, got {}: there is no grain for this force",
                        contact_columns[column], grains - 1, *grain));
        return std::nullopt;
    }

    std::optional<int> read_partner() {
        if (const auto wall = find_wall(recording_.box, table_.text(2))) return wall_partner(*wall);
        if (to_whole_number(table_.text(2))) return read_grain(2);
        std::vector<std::string_view> names;
        for (const Wall wall : walls_of(recording_.box)) names.push_back(wall_name(recording_.box, wall));
        table_.problem(fmt::format("partner must be a grain's number or one of {}, got {}",
                                   fmt::join(names, ", "), quoted(table_.text(2))));
        return std::nullopt;
    }

    std::optional<Contact> read_contact() {
        const auto grain = read_grain(1), partner = read_partner();
        double value[6];
        bool is_whole = grain && partner;
        for (std::size_t k = 0; k < 6; ++k) {
            const auto number = table_.number(3 + k);
            value[k] = number.value_or(0);
            is_whole = is_whole && number;
        }
        if (!is_whole) return std::nullopt;
        if (*grain == *partner) {
            table_.problem(fmt::format("grain {} cannot touch itself", *grain));
            return std::nullopt;
        }
        Contact contact{*grain, *partner, Vec3(value[0], value[1], value[2]),
                        Vec3(value[3], value[4], value[5]), std::numeric_limits<double>::quiet_NaN()};
        check_units(contact);
        if (!is_wall(contact.partner) && contact.partner < contact.grain) {  // listed from the other side
            std::swap(contact.grain, contact.partner);
            contact.force = -contact.force;
        }
        return contact;
    }

    void check_units(const Contact& contact) {
        const Box& box = recording_.box;
        const Vec3 size(box.size_x, box.size_y, recording_.scans.front().plate_z);
        const bool far_off = !is_periodic(box) && ((contact.point.array() < -margin_.array()).any() ||
                                                   (contact.point.array() > (size + margin_).array()).any());
        if (box.size_x > 0 && far_off)
            table_.problem_once(
                "unit",
                fmt::format("x_m, y_m and z_m must lie in the box of {} by {} m, got {}, {} and {}: divide "
                            "by 1000 if they are in millimetres",
                            box.size_x, box.size_y, contact.point.x(), contact.point.y(), contact.point.z()));
        if (contact.force.norm() > largest_force_)
            table_.problem_once(
                "force",
                fmt::format("fx_N, fy_N and fz_N must be in newtons: {} is more than such grains can "
                            "carry; divide by 1000 if it is in millinewtons",
                            contact.force.norm()));
    }

    Table& table_;
    Recording& recording_;
    double largest_force_;   ///< [N]
    Vec3 margin_;            ///< largest distance of a measured point from the box [m]
    std::vector<Row> rows_;  ///< of this frame
    long frame_ = -1;
};

}  // namespace

std::optional<long> read_frame(Table& table, const Recording& recording, long previous) {
    const auto frame = table.whole_number(0, 0);
    const long last = static_cast<long>(recording.scans.size()) - 1;
    if (!frame) return std::nullopt;
    if (*frame > last) {
        table.problem_once("last",
                           fmt::format("frame must be one of plate.csv, 0 to {}, got {}", last, *frame));
        return std::nullopt;
    }
    if (*frame < previous) {
        table.problem_once(
            "order", fmt::format("frames must be in order, got {} after {}: sort the rows by frame", *frame,
                                 previous));
        return std::nullopt;
    }
    return frame;
}

void read_contacts(Table& table, double youngs_modulus, Recording& recording) {
    ContactReader(table, youngs_modulus, recording).read();
}

}  // namespace mcdem::experiment
