#include <fmt/format.h>

#include <limits>
#include <map>

#include "experiment/measurements.h"
#include "scene/packing_fields.h"

namespace mcdem {
namespace {

class ContactReader {
public:
    ContactReader(Table& table, Recording& recording) : table_(table), recording_(recording) {}

    void read() {
        while (table_.next()) {
            const auto frame = read_frame();
            const auto contact = read_contact();
            if (!frame || !contact) continue;
            if (*frame != frame_) lines_.clear();
            frame_ = *frame;
            const auto [first, is_new] =
                lines_.try_emplace({contact->grain, contact->partner}, table_.where());
            if (is_new)
                recording_.scans[static_cast<std::size_t>(frame_)].contacts.push_back(*contact);
            else
                table_.problem(
                    fmt::format("this contact is there twice in frame {}, first in {}: list each pair once",
                                frame_, first->second));
        }
    }

private:
    std::optional<long> read_frame() {
        const auto frame = table_.whole_number(0, 0);
        const long last = static_cast<long>(recording_.scans.size()) - 1;
        if (!frame) return std::nullopt;
        if (*frame > last) {
            table_.problem_once("last",
                                fmt::format("frame must be one of plate.csv, 0 to {}, got {}", last, *frame));
            return std::nullopt;
        }
        if (*frame < frame_) {
            table_.problem_once(
                "order", fmt::format("frames must be in order, got {} after {}: sort the rows by frame",
                                     *frame, frame_));
            return std::nullopt;
        }
        return frame;
    }

    std::optional<int> read_grain(std::size_t column) {
        const auto grain = table_.whole_number(column, 0);
        if (!grain) return std::nullopt;
        const long grains = static_cast<long>(recording_.diameter.size());
        if (*grain < grains) return static_cast<int>(*grain);
        table_.problem(
            fmt::format("{} must be a grain of grains.csv, 0 to {}, got {}: there is no grain for this force",
                        contact_columns()[column], grains - 1, *grain));
        return std::nullopt;
    }

    std::optional<int> read_partner() {
        if (const auto wall = parse<Wall>(table_.text(2))) return wall_partner(*wall);
        if (to_whole_number(table_.text(2))) return read_grain(2);
        table_.problem(fmt::format("partner must be a grain's number or one of {}, got {}", all_names<Wall>(),
                                   quoted(table_.text(2))));
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
        const double width = std::max(box.size_x, box.size_y);
        if (width > 0 &&
            contact.point.head<2>().cwiseAbs().maxCoeff() > 2 * width + recording_.diameter.front())
            table_.problem_once(
                "unit", fmt::format("x_m and y_m must lie in the box of {} by {} m, got {} and {}: divide by "
                                    "1000 if they are in millimetres",
                                    box.size_x, box.size_y, contact.point.x(), contact.point.y()));
    }

    Table& table_;
    Recording& recording_;
    std::map<std::pair<int, int>, std::string> lines_;  ///< of the contacts of this frame
    long frame_ = 0;
};

}  // namespace

const std::vector<std::string>& contact_columns() {
    static const std::vector<std::string> columns{"frame", "grain", "partner", "x_m", "y_m",
                                                  "z_m",   "fx_N",  "fy_N",    "fz_N"};
    return columns;
}

void read_contacts(Table& table, Recording& recording) { ContactReader(table, recording).read(); }

}  // namespace mcdem
