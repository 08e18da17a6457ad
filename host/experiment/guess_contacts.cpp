// What a table of contacts means: which numbers are grains and which walls, on whom a force is, in which
// units.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "experiment/findings.h"
#include "experiment/guess.h"

namespace mcdem {
namespace {

using One = ContactFrames::One;
constexpr std::size_t most_rows = 200'000;  // of a file that a guess looks at
constexpr double near =
    1.2;  // of the sum of radii, or of the radius at a wall: touching, measurement errors included

/// The contacts with the grains' places: in frames in which these are known.
class Places {
public:
    Places(const ImportTable& table, const ContactFrames& frames, const GrainFrames& grains)
        : grains_(grains) {
        for (std::size_t f = 0; f < frames.keys.size(); ++f) {
            const int at = grains.frame_of(table.map.word("frames_by", "plate"), frames.keys[f], f);
            if (at < 0) continue;
            for (const One& one : frames.contacts[f])
                all_.push_back({&one.contact, static_cast<std::size_t>(at)});
        }
    }
    template <class Each>
    void pairs(const Each& each) const {
        for (const auto& [contact, frame] : all_)
            if (!is_wall(contact->partner)) {
                const Vec3 line = at(grains_.position[frame], contact->grain) -
                                  at(grains_.position[frame], contact->partner);
                each(*contact, line, radius(contact->grain), radius(contact->partner));
            }
    }
    template <class Each>
    void all(const Each& each) const {
        for (const auto& [contact, frame] : all_)
            each(*contact, at(grains_.position[frame], contact->grain), radius(contact->grain));
    }

private:
    double radius(int grain) const { return grains_.diameter[static_cast<std::size_t>(grain)] / 2; }
    const GrainFrames& grains_;
    std::vector<std::pair<const Contact*, std::size_t>> all_;
};

ContactFrames read(const ImportTable& table, const GrainFrames& grains) {
    ExperimentProblems ignored;
    return import_contacts(table, grains, ignored, most_rows);
}

/// The offset with which nearly all pairs touch.
void guess_offset(ImportTable& table, const GrainFrames& grains) {
    double most = -1;
    long best = 0;
    // Yade's walls may count before its grains.
    for (const long offset : {0L, 1L, -1L, -2L, -3L, -4L, -5L, -6L}) {
        ImportTable trial = table;
        trial.map.entries["id_offset"] = guess(std::to_string(offset), Sure::stated, "");
        const auto others = strangers(trial, grains, offset, most_rows);
        if (others.size() > 12) continue;  // walls are few
        set_walls(trial, others, grains);
        const ContactFrames frames = read(trial, grains);
        long touching = 0, known = 0;
        Places(table, frames, grains).pairs([&](const Contact&, const Vec3& line, double a, double b) {
            ++known;
            touching += line.norm() < near * (a + b) ? 1 : 0;
        });
        const double share = known > 0 ? static_cast<double>(touching) / static_cast<double>(known) : 0;
        if (share > most + 0.05) most = share, best = offset;
    }
    const bool pairs = most > 0;
    table.map.entries["id_offset"] =
        guess(std::to_string(best),
              most > 0.9 ? Sure::sure
              : pairs    ? Sure::unclear
                         : Sure::likely,
              pairs ? fmt::format("{:.0f} % of the pairs touch then{}", 100 * most,
                                  most > 0.9 ? "" : ": numbers of grains, frames or columns may be others")
                    : "no pairs to tell it by");
    set_walls(table, strangers(table, grains, best, all_rows), grains);
    if (table.map.walls.size() > 6)
        table.map.entries["partner"] =
            guess(table.map.word("partner", ""), Sure::unclear, "more than six of its numbers are no grains");
}

/// +1 where forces push grains apart as they stand, -1 where they do turned round: by pairs, else by walls
/// near by.
double outward(const Places& places, const Box& box) {
    double pairs = 0, count = 0;
    places.pairs([&](const Contact& contact, const Vec3& line, double, double) {
        if (!(contact.force.norm() > 0) || !(line.norm() > 0)) return;
        pairs += contact.force.normalized().dot(line.normalized());
        ++count;
    });
    if (count >= 3) return pairs / count;
    double walls = 0;
    count = 0;
    places.all([&](const Contact& contact, const Vec3& centre, double) {
        if (!is_wall(contact.partner) || !(contact.force.norm() > 0)) return;
        int axis = 0;
        contact.force.cwiseAbs().maxCoeff(&axis);
        if (axis == 2) return;  // the plate's place is not known here
        const double size = axis == 0 ? box.size_x : box.size_y;
        walls += (centre[axis] < size / 2) == (contact.force[axis] > 0) ? 1 : -1;
        ++count;
    });
    return count > 0 ? walls / count : 0;
}

/// Forces lie along the lines of centres where fz counts the way that it should.
void guess_force_upwards(ImportTable& table, const GrainFrames& grains, const Box& box) {
    constexpr double clear = 0.2;
    ImportTable other = table;
    Guess &fz = table.map.entries["fz"], &fz_turned = other.map.entries["fz"];
    fz_turned = turned(fz);
    const auto aligned = [&](const ImportTable& trial) {
        const ContactFrames frames = read(trial, grains);
        return std::abs(outward(Places(trial, frames, grains), box));
    };
    const double as_it_is = aligned(table), other_way = aligned(other);
    if (std::abs(as_it_is - other_way) < clear) {
        if (grains.sign.z() > 0) return;
        fz = fz_turned;
        fz.sure = Sure::unclear;
        fz.why = "z of the grains is downwards: are the forces too? If not, remove the -";
    } else if (other_way > as_it_is) {
        const Sure before = fz.sure;
        fz = fz_turned;
        fz.sure = before == Sure::unclear ? Sure::unclear : Sure::sure;
        fz.why += fmt::format(
            "; the other way, for so forces lie along the lines of centres (mean cosine {:.2f}, else {:.2f})",
            other_way, as_it_is);
    }
}

void guess_force_on(ImportTable& table, const GrainFrames& grains, const Box& box) {
    if (!table.map.has("fx") || !table.map.has("fy") || !table.map.has("fz")) return;
    guess_force_upwards(table, grains, box);
    const ContactFrames frames = read(table, grains);
    const double sign = outward(Places(table, frames, grains), box);
    table.map.entries["force_on"] =
        guess(sign < 0 ? "partner" : "grain", std::abs(sign) > 0.5 ? Sure::sure : Sure::unclear,
              std::abs(sign) > 0.5 ? "so forces push grains apart"
                                   : "forces neither push grains apart nor together");
}

void guess_sides(ImportTable& table, const ContactFrames& frames) {
    long twice = 0, pairs = 0;
    for (const auto& contacts : frames.contacts) {
        std::set<std::pair<int, int>> seen;
        for (const One& one : contacts) {
            if (is_wall(one.contact.partner)) continue;
            ++pairs;
            twice += seen.contains({one.contact.partner, one.contact.grain}) ? 1 : 0;
            seen.insert({one.contact.grain, one.contact.partner});
        }
    }
    const bool both = 2 * twice > 0.5 * static_cast<double>(pairs);
    table.map.entries["sides"] =
        guess(both ? "both" : "one", twice == 0 || 2 * twice == pairs ? Sure::sure : Sure::likely,
              fmt::format("{} of {} pairs are there from either side", 2 * twice, pairs));
}

/// The units in which contact points lie at the surfaces of their grains.
std::vector<std::string> point_units(const ImportTable& table, const GrainFrames& grains) {
    std::vector<std::string> fits;
    for (const std::string unit : {"m", "cm", "mm", "um"}) {
        ImportTable trial = table;
        trial.map.entries["length_unit"] = guess(unit, Sure::stated, "");
        const ContactFrames frames = read(trial, grains);
        std::vector<double> ratios;
        Places(table, frames, grains).all([&](const Contact& contact, const Vec3& centre, double radius) {
            ratios.push_back((contact.point - centre).norm() / radius);
        });
        if (ratios.empty()) continue;
        const double middle = median(std::move(ratios));
        if (middle > 0.6 && middle < 1.3) fits.push_back(unit);
    }
    return fits;
}

/// Unit and direction of contact points: z may count the other way than it was taken for.
void guess_point_unit(ImportTable& table, const GrainFrames& grains) {
    if (!table.map.has("x") || !table.map.has("z")) return;
    const Guess* named = table.map.find("length_unit");
    auto fits = point_units(table, grains);
    if (ImportTable other = table; fits.empty()) {
        other.map.entries["z"] = turned(other.map.entries["z"]);
        fits = point_units(other, grains);
        if (!fits.empty()) {
            table.map.entries["z"] = other.map.entries["z"];
            table.map.entries["z"].why += "; the other way, for so the points lie on the grains' surfaces";
        }
    }
    const bool one = fits.size() == 1;
    if (named && (!one || fits.front() == named->word()))
        table.map.entries["length_unit"].why += one ? ", and the points lie on the grains' surfaces" : "";
    else
        table.map.entries["length_unit"] =
            guess(one && !named ? fits.front()
                  : named       ? named->word()
                                : "m",
                  one && !named ? Sure::sure : Sure::unclear,
                  one ? fmt::format("in {} the points lie on the grains' surfaces", fits.front())
                      : "in no unit, or in several, do the points lie on the grains' surfaces");
}

void guess_force_unit(ImportTable& table, const GrainFrames& grains, const Experiment& known,
                      bool grains_in_metres) {
    MappedTable& map = table.map;
    if (map.has("force_unit")) return;
    ImportTable trial = table;
    trial.map.entries["force_unit"] = guess("N", Sure::stated, "");
    const ContactFrames frames = read(trial, grains);
    std::vector<double> ratios;
    Places(table, frames, grains).pairs([&](const Contact& contact, const Vec3& line, double a, double b) {
        const double overlap = a + b - line.norm();
        if (overlap > 0.01 * (a + b))
            ratios.push_back(contact.force.norm() / hertz_force(known, a, b, overlap));
    });
    const double ratio = ratios.size() < 5 ? std::nan("") : median(std::move(ratios));
    const auto fits = fitting_units(force_units, force_factor, ratio, 1, 1 / 3.1, 3.1);
    if (fits.size() == 1)
        map.entries["force_unit"] =
            guess(fits.front(), hertz_tells(fits.front()) ? Sure::sure : Sure::unclear,
                  fmt::format("then forces are {:.2g} times Hertz's from the overlaps",
                              ratio * force_factor(fits.front())));
    else if (table.parts.front()->format != TableFormat::text && grains_in_metres)
        map.entries["force_unit"] =
            guess("N", Sure::likely, "the grains are in metres, so the program counts in SI");
    else
        map.entries["force_unit"] = guess(
            "N", Sure::unclear,
            std::isfinite(ratio) ? fmt::format("as newtons forces would be {:.2g} times Hertz's", ratio)
                                 : "no name says it; with --set grains.youngs_modulus=.. the overlaps may");
}

}  // namespace

void guess_contact_meaning(ImportTable& table, const GrainFrames& grains, const Experiment& known) {
    if (grains.keys.empty()) {
        table.map.entries["id_offset"] = guess("0", Sure::unclear, "the grains' table cannot be read so far");
        return;
    }
    guess_offset(table, grains);
    guess_force_on(table, grains, known.recording.box);
    const ContactFrames frames = read(table, grains);
    guess_walls(table, frames, grains, known.recording.box);
    guess_sides(table, frames);
    guess_point_unit(table, grains);
    const double size = grains.diameter.front();
    guess_force_unit(table, grains, known, size < 1);
}

}  // namespace mcdem
