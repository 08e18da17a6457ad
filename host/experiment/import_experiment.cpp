#include "experiment/import_experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "experiment/findings.h"

namespace mcdem {
namespace {

/// Puts plate, grains and contacts together into one recording.
class Assembly {
public:
    Assembly(const std::vector<ImportTable>& tables, Experiment known)
        : tables_(tables), experiment_(std::move(known)) {}

    Imported run() {
        const auto plates = of(Role::plate), grains = of(Role::grains);
        if (plates.size() != 1)
            problems_.add(
                "plate",
                fmt::format("must be one table with the plate's position and force by frame, got {}: say "
                            "`role = \"plate\"` in the mapping, or give the table",
                            plates.size()));
        else
            place_plate(*plates.front());
        grains_ = import_grains(grains, problems_);
        if (!of(Role::contacts).empty() && grains.empty())
            problems_.add("grains", "must be a table of the grains, for contacts name them, got none");
        problems_.report();
        place_grains(grains);
        for (const ImportTable* table : of(Role::contacts)) place_contacts(*table);
        problems_.report();
        finish();
        return {std::move(experiment_), std::move(notes_)};
    }

private:
    void place_plate(const ImportTable& table) {
        const double start = recording().plate_start;
        if (table.map.find("displacement") && std::isnan(start))
            problems_.add(table.map.files.front(),
                          "displacements count downwards from plate.start, which must be given [m]: --set "
                          "plate.start=..");
        else
            plate_ = import_plate(table, start, problems_);
    }

    Recording& recording() { return experiment_.recording; }

    std::vector<const ImportTable*> of(Role role) const {
        std::vector<const ImportTable*> found;
        for (const ImportTable& table : tables_)
            if (table.map.role == role) found.push_back(&table);
        return found;
    }

    void place_grains(const std::vector<const ImportTable*>& tables) {
        recording().scans = plate_.scans;
        if (tables.empty()) return;
        const bool by_order = tables.front()->map.word("frames_by", "plate") == "order";
        recording().diameter = grains_.diameter;
        place_frames(grains_, by_order, plate_);
        for (std::size_t f = 0; f < grains_.keys.size(); ++f) {
            const int scan = grains_.row[f];
            if (scan < 0) {
                problem_once(grains_.first_row[f], "frame",
                             fmt::format("frame {} must be one of the plate's {} rows, got none like it: see "
                                         "frame and frames_by in the mapping",
                                         grains_.keys[f], plate_.scans.size()));
                continue;
            }
            recording().scans[static_cast<std::size_t>(scan)].position = grains_.position[f];
            check_inside(f, recording().scans[static_cast<std::size_t>(scan)].plate_z);
        }
        if (!grains_.row.empty()) drop_before(std::ranges::min(grains_.row));
    }

    void problem_once(const RowAt& row, const std::string& topic, const std::string& what) {
        add_problem_once(problems_, topic, row, what);
    }

    void check_inside(std::size_t frame, double plate_z) {
        const Vec3 size(recording().box.size_x, recording().box.size_y, plate_z);
        for (const Vec3& at : grains_.position[frame])
            if ((at.array() < 0).any() || (at.array() > size.array()).any())
                return problem_once(
                    grains_.first_row[frame], "inside",
                    fmt::format("centres must lie in the box of {} by {} m below the plate at {} m, got "
                                "{:.4g}, {:.4g}, "
                                "{:.4g} in frame {}: see length_unit, origin_x, origin_y, origin_z and "
                                "frames_by in the mapping",
                                size.x(), size.y(), size.z(), at.x(), at.y(), at.z(), grains_.keys[frame]));
    }

    /// An experiment begins with the grains; rows of the plate before are left out.
    void drop_before(int first) {
        if (first <= 0) return;
        notes_.push_back(
            fmt::format("the plate's first {} rows are left out: grains are known from then on", first));
        dropped_ = first;
    }

    void place_contacts(const ImportTable& table) {
        if (std::ranges::find(grains_.row, -1) != grains_.row.end()) return;  // told before
        const std::string by = table.map.word("frames_by", "plate");
        ContactFrames frames = import_contacts(table, grains_, problems_);
        for (std::size_t f = 0; f < frames.keys.size(); ++f) {
            auto& contacts = frames.contacts[f];
            if (contacts.empty()) continue;
            const int row = grains_.plate_row_of(by, frames.keys[f], f);
            if (row < 0) {
                problem_once(contacts.front().row, "frame",
                             fmt::format("frame {} must be one of the {}, got none like it: see frame and "
                                         "frames_by in the mapping",
                                         frames.keys[f], by == "grains" ? "grains' frames" : "plate's rows"));
                continue;
            }
            Scan& scan = recording().scans[static_cast<std::size_t>(row)];
            join(contacts, table.map.word("sides", "one") == "both", scan);
            add_contacts(contacts, frames.keys[f], scan);
        }
    }

    void add_contacts(std::vector<ContactFrames::One>& contacts, double key, Scan& scan) {
        for (auto& one : contacts) {
            if (!one.contact.point.allFinite() && !put_point(one.contact, scan))
                return problem_once(one.row, "point",
                                    fmt::format("a contact must have a point, or its grains a position in "
                                                "its frame {}, got neither",
                                                key));
            scan.contacts.push_back(one.contact);
        }
    }

    /// Each contact once, grain < partner; the mean of both sides where each is listed from either.
    void join(std::vector<ContactFrames::One>& contacts, bool both, const Scan& scan) {
        enum Seen { before, as_listed, turned_round, from_both };
        std::map<std::pair<int, int>, std::pair<std::size_t, Seen>> places;
        std::vector<ContactFrames::One> joined;
        double largest = 0;
        for (const auto& one : contacts) largest = std::max(largest, one.contact.force.norm());
        for (const Contact& contact : scan.contacts) places[{contact.grain, contact.partner}] = {0, before};
        for (ContactFrames::One one : contacts) {
            Contact& contact = one.contact;
            const bool turned = !is_wall(contact.partner) && contact.partner < contact.grain;
            if (turned) {
                std::swap(contact.grain, contact.partner);
                contact.force = -contact.force;
            }
            const Seen side = turned ? turned_round : as_listed;
            const auto [place, is_new] =
                places.try_emplace({contact.grain, contact.partner}, joined.size(), side);
            auto& [index, seen] = place->second;
            if (is_new)
                joined.push_back(one);
            else if (!both || seen == before || seen == from_both || seen == side)
                tell_twice(one.row, seen != before && seen != from_both && seen != side);
            else {
                seen = from_both;
                take_mean(joined[index].contact, one, largest);
            }
        }
        contacts = std::move(joined);
    }

    void tell_twice(const RowAt& row, bool reversed) {
        problem_once(row, "twice",
                     reversed
                         ? "each contact must be there once in a frame, got it from its other side too: "
                           "write `sides = \"both\"` in the mapping where each is listed from either side"
                         : "each contact must be there once in a frame, got it again in the same "
                           "direction or in another table: make one row of rows of normal and "
                           "tangential parts, and leave out what is there twice");
    }

    /// Of both sides, turned alike. Weak forces may differ more: their errors are those of the strong ones.
    void take_mean(Contact& first, const ContactFrames::One& other, double largest) {
        constexpr double most_apart = 0.5, weak = 0.01;
        const Vec3 &a = first.force, &b = other.contact.force;
        if ((a - b).norm() > std::max(most_apart * std::max(a.norm(), b.norm()), weak * largest))
            problem_once(
                other.row, "sides",
                fmt::format("the forces of a contact's two sides must be opposite, got sizes of "
                            "{:.4g} and {:.4g} N, {:.4g} N apart when one is turned round: leave one "
                            "of the sides out of the table and write `sides = \"one\"`",
                            a.norm(), b.norm(), (a - b).norm()));
        first.force = (a + b).eval() / 2;
        first.point = (first.point + other.contact.point).eval() / 2;
    }

    /// Midway between the surfaces; on a wall under the centre.
    bool put_point(Contact& contact, const Scan& scan) const {
        if (scan.position.empty()) return false;
        const Vec3& centre = at(scan.position, contact.grain);
        if (is_wall(contact.partner)) {
            const Box& box = experiment_.recording.box;
            const double place[] = {0, box.size_x, 0, box.size_y, 0, scan.plate_z};
            const int wall = static_cast<int>(wall_of(contact.partner));
            contact.point = centre;
            contact.point[wall / 2] = place[wall];
            return true;
        }
        const Vec3 line = at(scan.position, contact.partner) - centre;
        const double distance = line.norm();
        if (!(distance > 0)) return false;
        const double first = radius_of(experiment_.recording, contact.grain),
                     second = radius_of(experiment_.recording, contact.partner);
        contact.point = centre + (first + distance - second) / (2 * distance) * line;
        return true;
    }

    void finish() {
        Recording& all = recording();
        if (std::isnan(all.plate_start))
            for (const Scan& scan : all.scans) all.plate_start = std::fmax(all.plate_start, scan.plate_z);
        all.scans.erase(all.scans.begin(), all.scans.begin() + dropped_);
        const int cycle = all.scans.empty() ? 0 : all.scans.front().cycle;
        for (std::size_t s = 0; s < all.scans.size(); ++s) {
            all.scans[s].frame = static_cast<int>(s);
            all.scans[s].cycle -= cycle;
        }
        all.label = experiment_.name;
    }

    const std::vector<ImportTable>& tables_;
    Experiment experiment_;
    ExperimentProblems problems_;
    std::vector<std::string> notes_;
    PlateRows plate_;
    GrainFrames grains_;
    int dropped_ = 0;
};

Guess not_guessed(Role role, std::string_view key) {
    const std::string_view words = find_mapping_key(role, key)->words;
    return {{std::string(words.substr(0, words.find(' ')))}, Sure::unclear, "nothing tells it", 0};
}

}  // namespace

Imported import_tables(const std::vector<ImportTable>& tables, Experiment known) {
    return Assembly(tables, std::move(known)).run();
}

Mapping mapping_of(const std::vector<ImportTable>& tables) {
    Mapping mapping;
    for (const ImportTable& table : tables) {
        MappedTable& map = mapping.tables.emplace_back(table.map);
        for (const std::string_view key : must_be_stated(map))
            if (!map.has(key)) map.entries[std::string(key)] = not_guessed(map.role, key);
    }
    return mapping;
}

std::vector<std::string> wrong_rows(const std::vector<ImportTable>& tables) {
    std::vector<std::string> all;
    for (const ImportTable& table : tables) {
        const bool columns_known = std::ranges::all_of(table.map.entries, [](const auto& entry) {
            return entry.second.sure != Sure::unclear || entry.first.find("_") != std::string::npos;
        });
        if (!columns_known || table.map.role_sure == Sure::unclear) continue;
        ExperimentProblems problems;
        if (table.map.role == Role::plate) import_plate(table, std::nan(""), problems);
        if (table.map.role == Role::grains) import_grains({&table}, problems);
        const auto lines = problems.lines();
        all.insert(all.end(), lines.begin(), lines.end());
    }
    return all;
}

}  // namespace mcdem
