// A recording as tables of a laboratory or of another program.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/recording.h"

namespace mcdem::test {

struct LabStyle {
    char separator = ';';
    char decimal = ',';
    bool units_named = true;
    double length = 1e3;  ///< units of the table per metre
    double force = 1e3;   ///< .. per newton
};

/// A table from column names and rows of cells; numbers have nine digits.
class LabTable {
public:
    LabTable(const LabStyle& style, const std::vector<std::string>& names) : style_(style) { add(names); }
    void add(const std::vector<std::string>& cells) {
        for (const std::string& cell : cells)
            text_ += (&cell == &cells.front() ? "" : std::string(1, style_.separator)) + cell;
        text_ += "\n";
    }
    std::string number(double value) const {
        std::string text = fmt::format("{:.9g}", value);
        std::ranges::replace(text, '.', style_.decimal);
        return text;
    }
    std::string length(double value) const { return number(value * style_.length); }
    std::string force(double value) const { return number(value * style_.force); }
    const std::string& text() const { return text_; }

private:
    LabStyle style_;
    std::string text_;
};

/// Without phase and cycle; frames are numbered by time, half a second each.
inline std::string lab_plate(const Recording& recording, const LabStyle& style) {
    const std::string mm = style.units_named ? " [mm]" : "", mN = style.units_named ? " [mN]" : "";
    LabTable table(style, {"Kraft" + mN, "Zeit [s]", "Hoehe" + mm});
    for (const Scan& scan : recording.scans)
        table.add(
            {table.force(scan.top_force()), table.number(0.5 * scan.frame), table.length(scan.plate_z)});
    return table.text();
}

/// Radii; ids start at 1.
inline std::string lab_grains(const Recording& recording, const LabStyle& style) {
    const std::string mm = style.units_named ? " [mm]" : "";
    LabTable table(style, {"Radius" + mm, "z" + mm, "Nr.", "x" + mm, "Zeit [s]", "y" + mm});
    for (const Scan& scan : recording.scans)
        for (std::size_t i = 0; i < scan.position.size(); ++i) {
            const Vec3& at = scan.position[i];
            table.add({table.length(recording.diameter[i] / 2), table.length(at.z()), std::to_string(i + 1),
                       table.length(at.x()), table.number(0.5 * scan.frame), table.length(at.y())});
        }
    return table.text();
}

/// Walls by name; other columns in between.
inline std::string lab_contacts(const Recording& recording, const LabStyle& style) {
    const std::string mm = style.units_named ? " [mm]" : "", mN = style.units_named ? " [mN]" : "";
    const char* const walls[] = {"links", "rechts", "vorn", "hinten", "Boden", "Deckel"};
    LabTable table(style, {"fz" + mN, "Korn 2", "fx" + mN, "x" + mm, "fy" + mN, "z" + mm, "Guete", "y" + mm,
                           "Korn 1", "Zeit [s]"});
    for (const Scan& scan : recording.scans)
        for (const Contact& c : scan.contacts)
            table.add({table.force(c.force.z()),
                       is_wall(c.partner) ? walls[static_cast<int>(wall_of(c.partner))]
                                          : std::to_string(c.partner + 1),
                       table.force(c.force.x()), table.length(c.point.x()), table.force(c.force.y()),
                       table.length(c.point.z()), "gut", table.length(c.point.y()),
                       std::to_string(c.grain + 1), table.number(0.5 * scan.frame)});
    return table.text();
}

/// LAMMPS' `dump custom`: timesteps 100 apart, ids from 1, rows in any order.
inline std::string dump_of_grains(const Recording& recording) {
    std::string text;
    for (const Scan& scan : recording.scans) {
        text += fmt::format(
            "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\nITEM: "
            "ATOMS id type x y z radius \n",
            100 * scan.frame, scan.position.size());
        for (std::size_t k = scan.position.size(); k-- > 0;) {
            const Vec3& at = scan.position[k];
            text += fmt::format("{} 1 {:.9g} {:.9g} {:.9g} {:.9g} \n", k + 1, at.x(), at.y(), at.z(),
                                recording.diameter[k] / 2);
        }
    }
    return text;
}

/// LIGGGHTS' `dump local` of `compute pair/gran/local id force`; for walls of wall/gran/local, with mesh
/// numbers from 0.
inline std::string dump_of_contacts(const Recording& recording, bool walls) {
    std::string text;
    for (const Scan& scan : recording.scans) {
        std::string rows;
        long count = 0;
        for (const Contact& c : scan.contacts) {
            if (is_wall(c.partner) != walls) continue;
            ++count;
            const std::string ids =
                walls ? fmt::format("{} 0 {}", static_cast<int>(wall_of(c.partner)), c.grain + 1)
                      : fmt::format("{} {} 0", c.grain + 1, c.partner + 1);
            rows += fmt::format("{} {:.9g} {:.9g} {:.9g} \n", ids, c.force.x(), c.force.y(), c.force.z());
        }
        text += fmt::format(
            "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ENTRIES\n{}\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n"
            "ITEM: ENTRIES c_p[1] c_p[2] c_p[3] c_p[4] c_p[5] c_p[6] \n",
            100 * scan.frame, count);
        text += rows;
    }
    return text;
}

}  // namespace mcdem::test
