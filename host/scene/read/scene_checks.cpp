#include "scene/read/scene_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/container.h"
#include "core/errors.h"
#include "scene/packing/generate_packing.h"
#include "scene/packing/make_packing.h"
#include "scene/packing/neighbour_slots.h"
#include "scene/packing/stated_box.h"
#include "scene/programme/cell_path.h"
#include "scene/read/resolve_species.h"

namespace mcdem::inline scene {
namespace {

using Found = std::optional<std::string>;

Found unless(bool good, std::string problem) { return good ? Found{} : Found{std::move(problem)}; }

Found positive_width(double stated, double error) {
    return unless(stated + error > 0, fmt::format("must leave a width, got {} of {} m", error, stated));
}

struct Check {
    std::vector<std::string_view> keys;  ///< the first one is reported
    enum class Packing { any, generated } applies;
    Found (*find)(const Settings&);
};

Found in_container(std::string_view key, const Settings& s) {
    const auto small = too_small_container(smallest_cell(s.replica), s.replica.numerics,
                                           s.generated.diameter_mean, s.generated.diameter_max);
    return small && small->key == key ? Found{small->what} : Found{};
}

/// A box that the grains would not cover once, but would if its size was given in millimetres.
Found millimetres(double width, const Settings& settings) {
    const auto& grains = settings.generated;
    return unless(
        width <= widest_box || width * 1e-3 < grains.diameter_max ||
            expected_height(grains, settings.replica.box, mixture_of(settings.replica)) >=
                grains.diameter_max,
        fmt::format("must be in metres, got {}, {:.3g} times packing.diameter_max: divide by 1000 if it is "
                    "in millimetres",
                    width, width / grains.diameter_max));
}

/// A plate that starts far above all grains, as if its height was given in millimetres.
Found plate_in_millimetres(const Settings& settings) {
    constexpr double too_high = 50;
    const auto& replica = settings.replica;
    const auto& generated = settings.generated;
    const double height = std::max({expected_height(generated, replica.box, mixture_of(replica)),
                                    generated.diameter_max, replica.box.size_x, replica.box.size_y});
    return unless(is_cell(replica.box) || replica.plate.start <= too_high * height,
                  fmt::format("must be in metres, got {}, {:.3g} times the height of the packing: divide by "
                              "1000 if it is in millimetres",
                              replica.plate.start, replica.plate.start / height));
}

/// Whether the box or the plate's start seems to be in millimetres. Checks that would then only report a
/// consequence are skipped.
bool seems_in_millimetres(const Settings& settings) {
    const Box& box = settings.replica.box;
    const double width = is_cylinder(box) ? cylinder_radius(box) : std::max(box.size_x, box.size_y);
    return millimetres(width, settings) || plate_in_millimetres(settings);
}

/// Positions must be precise enough for overlaps of a thousandth of a radius.
Found coarse_positions(const Settings& settings, double smallest_diameter) {
    if (settings.run.precision == Precision::double_precision) return {};
    const auto& replica = settings.replica;
    const float farthest =
        static_cast<float>(std::max({replica.box.size_x, replica.box.size_y, replica.plate.start}));
    const double apart = farthest - std::nextafter(farthest, 0.0f);
    return unless(
        apart <= 1e-4 * smallest_diameter / 2,
        fmt::format(
            "must be double, or the box smaller, got float: {:.3g} m from its corner, float tells "
            "positions apart that differ by {:.1g} m, which is too coarse for a smallest radius of {:.3g} m",
            farthest, apart, smallest_diameter / 2));
}

// clang-format off
const std::vector<Check> checks{
    {{"plate.start", "packing.count", "packing.diameter_mean", "packing.diameter_max", "packing.packing_fraction", "box.size_x", "box.size_y"}, Check::Packing::generated, plate_in_millimetres},
    {{"numerics.precision", "packing.diameter_min", "box.size_x", "box.size_y", "plate.start"}, Check::Packing::generated, [](const Settings& s) {
        return seems_in_millimetres(s) ? Found{} : coarse_positions(s, s.generated.diameter_min);
    }},
    {{"plate.end", "plate.start"}, Check::Packing::any, [](const Settings& s) {
        const auto& plate = s.replica.plate;
        return unless(plate.end < plate.start, fmt::format("must be below plate.start = {}, got {}", plate.start, plate.end));
    }},
    {{"protocol.pause", "protocol.stop_at_scans"}, Check::Packing::any, [](const Settings& s) {
        const auto& protocol = s.replica.protocol;
        return unless(protocol.pause == 0 || protocol.stop_at_scans,
                      "needs protocol.stop_at_scans = true, because a plate that does not stop does not pause");
    }},
    {{"protocol.hold"}, Check::Packing::any, [](const Settings& s) {
        return unless(s.replica.protocol.hold == 0 || s.replica.programme.empty(),
                      "must be 0 where a [[programme]] is given: stage = \"hold\" says where it holds");
    }},
    {{"protocol.discard", "protocol.cycles"}, Check::Packing::any, [](const Settings& s) {
        const auto& protocol = s.replica.protocol;
        return unless(protocol.discard < protocol.cycles,
                      fmt::format("must be less than protocol.cycles = {}, got {}", protocol.cycles, protocol.discard));
    }},
    {{"protocol.scans_per_stroke", "protocol.cycles"}, Check::Packing::any, [](const Settings& s) {
        const long scans = 2L * s.replica.protocol.cycles * s.replica.protocol.scans_per_stroke;
        return unless(scans <= 1'000'000, fmt::format("must leave at most 1000000 scans in all, got {}", scans));
    }},
    {{"effects.plate_tilt_x", "effects.plate_tilt_y", "box.size_x", "box.size_y", "plate.end"}, Check::Packing::any, [](const Settings& s) {
        const auto& effects = s.replica.effects;
        const auto& box = s.replica.box;
        const double drop = (std::abs(effects.plate_tilt_x) * box.size_x + std::abs(effects.plate_tilt_y) * box.size_y) / 2;
        return unless(is_cell(s.replica.box) || drop < s.replica.plate.end,
                      fmt::format("and effects.plate_tilt_y must leave the plate's lowest corner above the floor at plate.end = {}, got {} and {}: it is {:.6g} m lower",
                                  s.replica.plate.end, effects.plate_tilt_x, effects.plate_tilt_y, drop));
    }},
    {{"container.shape", "effects.plate_tilt_x", "effects.plate_tilt_y"}, Check::Packing::any, [](const Settings& s) {
        const auto& effects = s.replica.effects;
        return unless(s.replica.box.shape != ContainerShape::periodic || (effects.plate_tilt_x == 0 && effects.plate_tilt_y == 0),
                      "must not be periodic where effects.plate_tilt_x or effects.plate_tilt_y is given: a tilted plate does not repeat");
    }},
    {{"container.shape", "effects.width_error_x", "effects.width_error_y"}, Check::Packing::any, [](const Settings& s) {
        const auto& effects = s.replica.effects;
        return unless(!is_periodic(s.replica.box) || (effects.width_error_x == 0 && effects.width_error_y == 0),
                      "must not be periodic where effects.width_error_x or effects.width_error_y is given: it has no side walls");
    }},
    {{"effects.width_error_x", "box.size_x"}, Check::Packing::any, [](const Settings& s) {
        return positive_width(s.replica.box.size_x, s.replica.effects.width_error_x);
    }},
    {{"effects.width_error_y", "box.size_y"}, Check::Packing::any, [](const Settings& s) {
        return positive_width(s.replica.box.size_y, s.replica.effects.width_error_y);
    }},
    {{"container.height", "container.shape", "packing.file"}, Check::Packing::any, [](const Settings& s) {
        return unless(!is_cell(s.replica.box) || s.packing_file.empty() || !std::isnan(s.cell_height),
                      "must be given where the packing of a cell is a file: the file does not say it");
    }},
    {{"container.height", "container.shape", "packing.diameter_max", "packing.diameter_mean", "numerics.skin", "numerics.probe_gap"},
     Check::Packing::generated, [](const Settings& s) {
        return in_container("container.height", s);
    }},
    {{"container.radius", "container.shape", "packing.diameter_max"}, Check::Packing::generated, [](const Settings& s) {
        return in_container("container.radius", s);
    }},
    {{"container.size_x", "container.shape", "packing.diameter_max", "packing.diameter_mean", "numerics.skin", "numerics.probe_gap"},
     Check::Packing::generated, [](const Settings& s) {
        return in_container("container.size_x", s);
    }},
    {{"container.size_y", "container.shape", "packing.diameter_max", "packing.diameter_mean", "numerics.skin", "numerics.probe_gap"},
     Check::Packing::generated, [](const Settings& s) {
        return in_container("container.size_y", s);
    }},
    {{"container.radius", "packing.diameter_max", "packing.count", "packing.diameter_mean", "packing.packing_fraction"},
     Check::Packing::generated, [](const Settings& s) {
        return is_cylinder(s.replica.box) ? millimetres(cylinder_radius(s.replica.box), s) : Found{};
    }},
    {{"effects.diameter_error", "packing.diameter_min"}, Check::Packing::generated, [](const Settings& s) {
        return unless(s.replica.effects.diameter_error > -s.generated.diameter_min,
                      fmt::format("must be above minus packing.diameter_min = {}, got {}", s.generated.diameter_min, s.replica.effects.diameter_error));
    }},
    {{"effects.polydispersity", "packing.diameter_mean"}, Check::Packing::generated, [](const Settings& s) {
        const double sd = s.replica.effects.polydispersity;
        return unless(sd <= 0.2 * s.generated.diameter_mean,
                      fmt::format("must be at most a fifth of packing.diameter_mean = {}, got {}", s.generated.diameter_mean, sd));
    }},
    {{"packing.diameter_min", "packing.diameter_mean"}, Check::Packing::generated, [](const Settings& s) {
        const auto& g = s.generated;
        return unless(g.diameter_min <= g.diameter_mean,
                      fmt::format("must be at most packing.diameter_mean = {}, got {}", g.diameter_mean, g.diameter_min));
    }},
    {{"packing.diameter_max", "packing.diameter_mean"}, Check::Packing::generated, [](const Settings& s) {
        const auto& g = s.generated;
        return unless(g.diameter_max >= g.diameter_mean,
                      fmt::format("must be at least packing.diameter_mean = {}, got {}", g.diameter_mean, g.diameter_max));
    }},
    {{"packing.diameter_max", "packing.diameter_min"}, Check::Packing::generated, [](const Settings& s) {
        const auto& g = s.generated;
        return unless(g.diameter_max <= 10 * g.diameter_min,
                      fmt::format("must be at most 10 times packing.diameter_min = {}, got {}", g.diameter_min, g.diameter_max));
    }},
    {{"box.size_x", "packing.diameter_max"}, Check::Packing::generated, [](const Settings& s) {
        return unless(is_cylinder(s.replica.box) || s.replica.box.size_x >= s.generated.diameter_max,
                      fmt::format("must be at least packing.diameter_max = {}, got {}", s.generated.diameter_max, s.replica.box.size_x));
    }},
    {{"box.size_x", "packing.diameter_max", "packing.count", "packing.diameter_mean", "packing.packing_fraction"},
     Check::Packing::generated, [](const Settings& s) {
        return is_cylinder(s.replica.box) ? Found{} : millimetres(s.replica.box.size_x, s);
    }},
    {{"box.size_y", "packing.diameter_max", "packing.count", "packing.diameter_mean", "packing.packing_fraction"},
     Check::Packing::generated, [](const Settings& s) {
        return is_cylinder(s.replica.box) ? Found{} : millimetres(s.replica.box.size_y, s);
    }},
    {{"box.size_y", "packing.diameter_max"}, Check::Packing::generated, [](const Settings& s) {
        return unless(is_cylinder(s.replica.box) || s.replica.box.size_y >= s.generated.diameter_max,
                      fmt::format("must be at least packing.diameter_max = {}, got {}", s.generated.diameter_max, s.replica.box.size_y));
    }},
    {{"packing.position_jitter", "packing.diameter_mean"}, Check::Packing::generated, [](const Settings& s) {
        const double jitter = s.replica.packing.position_jitter;
        return unless(jitter <= 0.1 * s.generated.diameter_mean,
                      fmt::format("must be at most a tenth of packing.diameter_mean = {}, got {}", s.generated.diameter_mean, jitter));
    }},
    {{"packing.packing_fraction", "packing.count", "packing.diameter_mean", "packing.diameter_sd", "packing.diameter_min",
      "packing.diameter_max", "box.size_x", "box.size_y", "plate.start"}, Check::Packing::generated, [](const Settings& s) {
        const auto& g = s.generated;
        if (g.diameter_min > g.diameter_mean || g.diameter_max < g.diameter_mean || seems_in_millimetres(s)) return Found{};
        const double height = expected_height(g, s.replica.box, mixture_of(s.replica));
        if (height < g.diameter_max)
            return Found{fmt::format("must leave room for the largest grain, got {}: the grains would fill the box up to {:.6g} m only; "
                                     "lower it, or take more grains or a smaller box", g.packing_fraction, height)};
        return unless(height <= 1.01 * s.replica.plate.start,
                      fmt::format("must keep the grains below plate.start = {}, got {}: they would fill the box up to {:.6g} m; "
                                  "raise it or plate.start", s.replica.plate.start, g.packing_fraction, height));
    }},
};
// clang-format on

/// If sizes come from species, problems do not refer to keys of [packing].
CrossProblem of_species(const Settings& settings, CrossProblem problem) {
    if (settings.replica.species.empty()) return problem;
    const auto replace = [&](std::string_view key, std::string_view words) {
        for (std::size_t at; (at = problem.what.find(key)) != problem.what.npos;)
            problem.what.replace(at, key.size(), words);
        if (problem.key == key) {
            problem.key = "species.1.sizes";
            problem.what = fmt::format("and those of the others: {} {}", words, problem.what);
        }
    };
    replace("packing.diameter_min", "the smallest diameter");
    replace("packing.diameter_max", "the largest diameter");
    replace("packing.diameter_mean", "the mean diameter");
    return problem;
}

}  // namespace

std::vector<CrossProblem> cross_problems(const Settings& settings,
                                         const std::set<std::string, std::less<>>& bad) {
    std::vector<CrossProblem> problems;
    for (const Check& check : checks) {
        if (check.applies == Check::Packing::generated && !settings.packing_file.empty()) continue;
        // Species without consistent sizes are reported by species_checks.cpp.
        if (check.applies == Check::Packing::generated && !has_sizes(settings.replica)) continue;
        if (std::ranges::any_of(check.keys, [&](auto key) { return bad.contains(key); })) continue;
        if (const Found problem = check.find(settings))
            problems.push_back(of_species(settings, {std::string(check.keys.front()), *problem}));
    }
    return problems;
}

namespace {

/// The file's density must be that of the scene, or that minus the fluid's, which some codes use for both.
Found other_density(const FilePacking& packing, const Settings& settings) {
    constexpr double rounding = 1e-4;  // six digits of a density, or of a mass and a cubed diameter
    const Replica& replica = settings.replica;
    for (std::size_t i = 0; i < packing.density.size(); ++i) {
        const std::size_t s = packing.species_of(i);
        const GrainMaterial& material =
            replica.species.empty() ? replica.grains : replica.species[s].material;
        const double stated = packing.density[i];
        const auto is = [&](double value) { return std::abs(stated - value) <= rounding * stated; };
        if (is(material.density) || is(material.excess_density)) continue;
        const std::string key =
            replica.species.empty() ? "grains.density" : fmt::format("species.{}.density", s + 1);
        return fmt::format(
            "{}: the density of grain {}, counted from 0, must be {} = {} kg/m3 of the scene, or its excess "
            "density {}, got {:.9g}: set {} = {:.9g}, or correct the file",
            settings.packing_file, i, key, material.density, material.excess_density, stated, key, stated);
    }
    return std::nullopt;
}

std::vector<std::string> problems_of_species(FilePacking packing, const Settings& settings) {
    try {
        assign_species(packing, settings.replica, settings.packing_file);
        if (const auto other = other_density(packing, settings)) return {*other};
        return {};
    } catch (const InputError& error) {
        return error.problems();
    }
}

/// The engine would stop at the first step.
Found deep_overlap(const Settings& settings, CheckedFile& file) {
    const Replica& replica = settings.replica;
    const PlateFace plate = plate_face(replica, replica.plate.start);
    if (!file.deepest) file.deepest = deepest_pair(file.packing, replica.box, plate.z);
    if (file.deepest->overlap <= replica.numerics.overlap_limit) return std::nullopt;
    return fmt::format(
        "{}: grains must overlap by at most numerics.overlap_limit = {} of the sum of their radii, got "
        "{:.2g} (of unequal grains times the ratio of the radii) for "
        "grains {} and {}, counted from 0: is one of them listed twice, or a diameter too large?",
        settings.packing_file, replica.numerics.overlap_limit, file.deepest->overlap, file.deepest->first,
        file.deepest->second);
}

MostNeighbours neighbours_in_file(const Settings& settings, CheckedFile& file) {
    const Replica& replica = settings.replica;
    const double gap = list_gap(replica.numerics, file.packing);
    const auto [place, is_new] = file.neighbours.try_emplace(gap);
    if (is_new) {
        const PlateFace plate = plate_face(replica, replica.plate.start);
        place->second = most_neighbours(file.packing, replica.box, plate.z, gap);
    }
    return place->second;
}

/// The engine would stop at the first step.
Found too_many_neighbours(const Settings& settings, CheckedFile& file) {
    const auto [grain, count] = neighbours_in_file(settings, file);
    const int most = settings.run.slots == 0 ? most_slots : settings.run.slots;
    if (count <= static_cast<std::size_t>(most)) return std::nullopt;
    const std::string found =
        fmt::format("{}: a grain must have at most {} near neighbours{}, got {} for grain {}, counted from 0",
                    settings.packing_file, most, most == most_slots ? "" : " (numerics.slots)", count, grain);
    if (count > most_slots) return fmt::format("{}: {}", found, widest_sizes);
    return fmt::format("{}: set numerics.slots = {}, or leave it out", found, slots_of_packing(count));
}

}  // namespace

int slots_needed(const Settings& settings, CheckedFiles& files) {
    if (settings.packing_file.empty())
        return has_sizes(settings.replica) ? slots_for(expected_neighbours(settings.generated.diameter_mean,
                                                                           settings.generated.diameter_max,
                                                                           settings.replica.numerics))
                                           : 0;
    const auto found = files.find({settings.packing_file, settings.packing_frame});
    if (found == files.end() || !found->second.problems.empty()) return 0;
    return slots_of_packing(neighbours_in_file(settings, found->second).count);
}

std::vector<std::string> packing_file_problems(const Settings& settings, CheckedFiles& files) {
    if (settings.packing_file.empty()) return {};
    const auto [place, is_new] = files.try_emplace({settings.packing_file, settings.packing_frame});
    CheckedFile& file = place->second;
    if (is_new) {
        try {
            file.packing = packing_file_of(settings).read();
            file.count = file.packing.size();
            file.smallest = *std::ranges::min_element(file.packing.diameter);
        } catch (const InputError& error) {
            file.problems = error.problems();
        }
    }
    if (!file.problems.empty()) return file.problems;
    if (auto found = compare_box(file.packing, file.packing.box, settings.replica.box);
        !found.problems.empty())
        return found.problems;
    if (auto problems = problems_of_species(file.packing, settings); !problems.empty()) return problems;
    auto problems =
        packing_problems(file.packing, settings.replica.box,
                         plate_face(settings.replica, settings.replica.plate.start), settings.packing_file);
    if (problems.empty())
        if (auto deep = deep_overlap(settings, file)) problems.push_back(*deep);
    if (problems.empty())
        if (auto many = too_many_neighbours(settings, file)) problems.push_back(*many);
    try {
        expect_room(settings.replica, file.packing);
    } catch (const InputError& error) {
        problems.push_back(fmt::format("{}: {}", settings.packing_file, error.what()));
    }
    if (settings.replica.packing.position_jitter > 0.1 * file.smallest)
        problems.push_back(fmt::format(
            "{}: packing.position_jitter must be at most a tenth of the smallest diameter {}, got {}",
            settings.packing_file, file.smallest, settings.replica.packing.position_jitter));
    if (!(settings.replica.effects.diameter_error > -file.smallest))
        problems.push_back(
            fmt::format("{}: effects.diameter_error must be above minus the smallest diameter {}, got {}",
                        settings.packing_file, file.smallest, settings.replica.effects.diameter_error));
    if (const auto coarse = coarse_positions(settings, file.smallest))
        problems.push_back(fmt::format("{}: numerics.precision {}", settings.packing_file, *coarse));
    return problems;
}

GrainsOfReplica grains_of(const Settings& settings, const CheckedFiles& files) {
    if (settings.packing_file.empty())
        return {static_cast<std::size_t>(settings.generated.count), settings.generated.diameter_min};
    const auto found = files.find({settings.packing_file, settings.packing_frame});
    if (found == files.end()) return {};
    return {found->second.count, found->second.smallest};
}

}  // namespace mcdem::scene
