#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "experiment/findings.h"
#include "experiment/guess.h"

namespace mcdem {
namespace {

struct Extent {
    Vec3 low = Vec3::Constant(INFINITY), high = Vec3::Constant(-INFINITY);
};

/// Of the grains' surfaces in the first frame.
Extent extent_of(const GrainFrames& grains) {
    Extent extent;
    for (std::size_t i = 0; i < grains.diameter.size(); ++i) {
        extent.low =
            extent.low.cwiseMin((grains.position.front()[i].array() - grains.diameter[i] / 2).matrix());
        extent.high =
            extent.high.cwiseMax((grains.position.front()[i].array() + grains.diameter[i] / 2).matrix());
    }
    return extent;
}

Guess unit_by_box(const Extent& extent, const Box& box, const Guess* named) {
    const double width = (extent.high - extent.low).x(), depth = (extent.high - extent.low).y();
    std::vector<std::string> fits;
    if (box.size_x > 0)
        for (const std::string& unit :
             fitting_units(length_units, length_factor, width, box.size_x, 0.55, 1.15))
            if (const double of_depth = depth * length_factor(unit) / box.size_y;
                of_depth > 0.55 && of_depth < 1.15)
                fits.push_back(unit);
    const std::string spans = fmt::format("the packing is {:.4g} by {:.4g} wide, the box {} by {} m", width,
                                          depth, box.size_x, box.size_y);
    if (named) {
        if (named->sure == Sure::unclear || box.size_x <= 0) return *named;
        if (fits == std::vector<std::string>{named->word()})
            return guess(named->word(), Sure::sure, "named so, and the packing fills the box");
        return guess(named->word(), Sure::unclear, "the columns' names say so, but " + spans);
    }
    if (fits.size() == 1) return guess(fits.front(), Sure::sure, spans);
    if (box.size_x <= 0)
        return guess(width > 0.5 ? "mm" : "m", Sure::unclear,
                     "no name says it, and the box is not known: --set box.size=[..] would tell");
    return guess(width > 0.5 ? "mm" : "m", Sure::unclear, "no unit makes the packing fit the box: " + spans);
}

void guess_origin(MappedTable& map, const Extent& extent, const GrainFrames& grains, const Box& box) {
    if (box.size_x <= 0) return;
    const double unit = length_factor(map.word("length_unit", "m")),
                 size[] = {box.size_x / unit, box.size_y / unit, INFINITY};
    const double margin = 0.12 * grains.diameter.front();  // soft grains reach into the walls
    for (int axis = 0; axis < 3; ++axis) {
        const double low = extent.low[axis], high = extent.high[axis];
        const std::string key = fmt::format("origin_{}", "xyz"[axis]);
        if (low >= -margin && high <= size[axis] + margin) {
            map.entries[key] = guess("0", axis == 2 && low > 5 * margin ? Sure::unclear : Sure::sure,
                                     fmt::format("grains reach from {:.4g} to {:.4g}", low, high));
            continue;
        }
        const double place = axis < 2 ? (low + high - size[axis]) / 2 : low;
        const double centred = -size[axis] / 2, sign = grains.sign[axis];
        map.entries[key] = guess(
            fmt::format("{:.6g}", sign * (axis < 2 && std::abs(place - centred) < margin ? centred : place)),
            Sure::unclear,
            fmt::format("grains reach from {:.4g} to {:.4g}", low, high) +
                (axis < 2 ? fmt::format(", the box is {:.4g} wide", size[axis])
                          : std::string(", and the floor is not at 0")));
    }
}

/// Radii taken for diameters look twice too far apart; the other way round, twice too near.
void check_size(MappedTable& map, GrainFrames& grains) {
    const double ratio = nearest_over_radii(grains.position.front(), grains.diameter);
    const std::string now = map.has("radius") ? "radius" : "diameter",
                      other = map.has("radius") ? "diameter" : "radius";
    const bool wrong = map.has("radius") ? ratio > 0.35 && ratio < 0.6 : ratio > 1.65 && ratio < 2.6;
    Guess& size = map.entries[now];
    if (wrong) {
        size.sure = Sure::unclear;
        size.why = fmt::format(
            "but then the nearest neighbours are {:.2f} times the sum of their radii apart: is it the {}? "
            "Then write {} in "
            "place of {}",
            ratio, other, other, now);
    } else if (ratio > 0.75 && ratio < 1.25 && size.sure != Sure::unclear) {
        size.why += fmt::format("; neighbours touch ({:.2f} of the sum of radii)", ratio);
    }
}

}  // namespace

std::vector<std::string> fitting_units(std::string_view units, double (*factor)(std::string_view),
                                       double value, double scale, double low, double high) {
    std::vector<std::string> fits;
    std::istringstream words{std::string(units)};
    for (std::string unit; words >> unit;)
        if (const double ratio = std::abs(value) * factor(unit) / std::abs(scale);
            ratio > low && ratio < high)
            fits.push_back(unit);
    return fits;
}

double hertz_force(const Experiment& known, double radius, double other, double overlap) {
    const auto modulus = material(known, "grains.youngs_modulus");
    const double poisson = material(known, "grains.poisson_ratio").value_or(0.4);
    if (!modulus || overlap <= 0) return modulus ? 0 : std::nan("");
    const double plane = *modulus / (1 - poisson * poisson),
                 curvature = 1 / radius + (other > 0 ? 1 / other : 0);
    return 4.0 / 3 * (other > 0 ? plane / 2 : plane) * std::sqrt(1 / curvature) * std::pow(overlap, 1.5);
}

GrainFrames grains_so_far(const std::vector<ImportTable>& tables) {
    std::vector<const ImportTable*> of_grains;
    for (const ImportTable& table : tables)
        if (table.map.role == Role::grains) of_grains.push_back(&table);
    ExperimentProblems problems;
    GrainFrames grains = import_grains(of_grains, problems);
    if (!problems.empty() || grains.keys.empty()) return {};
    for (const ImportTable& table : tables)
        if (table.map.role == Role::plate) {
            ExperimentProblems ignored;
            place_frames(grains, of_grains.front()->map.word("frames_by", "plate") == "order",
                         import_plate(table, 0, ignored));
        }
    return grains;
}

void guess_grain_lengths(ImportTable& table, const Experiment& known) {
    MappedTable& map = table.map;
    const Guess* found = map.find("length_unit");
    const std::optional<Guess> named = found ? std::optional<Guess>(*found) : std::nullopt;
    ImportTable plain = table;
    plain.map.entries["length_unit"] = guess("m", Sure::stated, "");
    ExperimentProblems problems;
    GrainFrames grains = import_grains({&plain}, problems);
    if (grains.keys.empty() || grains.diameter.empty()) return;
    check_size(map, grains);
    const Extent extent = extent_of(grains);
    map.entries["length_unit"] = unit_by_box(extent, known.recording.box, named ? &*named : nullptr);
    guess_origin(map, extent, grains, known.recording.box);
}

}  // namespace mcdem
