#include "ensemble/diagnosis/library_origin.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cl/program.h"
#include "core/errors.h"
#include "core/sha256.h"
#include "scene/packing/packing_fields.h"
#include "scene/programme/programme_text.h"
#include "scene/read/keys.h"

namespace mcdem::inline ensemble {
namespace {

/// Allowed difference between library and diagnosis, relative to the library.
struct MayDiffer {
    std::string_view begins;
    double part;
};
constexpr double by_any_part = std::numeric_limits<double>::infinity(), a_little = 0.1;
constexpr std::array may_differ{
    MayDiffer{"packing.", by_any_part},  // an experiment has its own packing
    MayDiffer{"plate.start",
              by_any_part},               // the experiment's zero of strain; the stroke is compared with the
    MayDiffer{"plate.end", by_any_part},  // library's levels
    MayDiffer{"protocol.scans_per_stroke", by_any_part},  // observations use the levels of the library
    MayDiffer{"box.size_", a_little},                     // measured separately for every experiment
    MayDiffer{"container.size_", a_little},
    MayDiffer{"mean diameter", a_little},
    MayDiffer{"grains", a_little},
};

double allowed_part(std::string_view name) {
    const auto* found = std::ranges::find_if(may_differ, [&](const MayDiffer& one) {
        return one.begins == "grains" ? name == one.begins : name.starts_with(one.begins);
    });
    return found == may_differ.end() ? 0 : found->part;
}

bool alike(std::string_view name, const std::string& made, const std::string& needed) {
    if (made == needed) return true;
    const double part = allowed_part(name);
    if (part == 0) return false;
    if (part == by_any_part) return true;
    const auto a = to_number(made), b = to_number(needed);
    return a && b && std::abs(*a - *b) <= part * std::abs(*a);
}

std::string observables_digest() {
    Sha256 digest;
    for (const Observable& observable : observables()) digest.add(observable.name).add(";");
    return digest.hex();
}

}  // namespace

std::map<std::string, std::string> library_origin(const TrialSettings& common, const Model& model,
                                                  std::size_t grains) {
    std::map<std::string, std::string> origin;
    Settings settings;
    settings.run = common.scene;
    settings.replica = model.replica;
    for (const Key& key : keys())
        if ((key.scope == Scope::replica && !key.name.starts_with("packing.")) ||
            key.name == "numerics.precision")
            origin[std::string(key.name)] = value_text(key, settings);
    origin.merge(programme_parameters(model.replica.programme));
    const Measurement& stated = model.instrument.stated;
    origin["measurement.position_error"] = fmt::format("{}", stated.position_error);
    origin["measurement.diameter_error"] = fmt::format("{}", stated.diameter_error);
    origin["measurement.force_error"] = fmt::format("{}", stated.force_error);
    origin["measurement.force_threshold"] = fmt::format("{}", stated.force_threshold);
    origin["mean diameter"] = fmt::format("{}", model.mean_diameter);
    origin["grains"] = fmt::format("{}", grains);
    origin["kernels"] = Sha256().add(program_text()).hex();
    origin["observables"] = observables_digest();
    origin["program"] = common.program.substr(
        0, common.program.find(' '));  // only the version; a commit need not change results
    return origin;
}

void expect_origin(const Library& library, const std::map<std::string, std::string>& needed,
                   const std::filesystem::path& file) {
    std::vector<std::string> problems;
    const auto value_in = [](const std::map<std::string, std::string>& origin, const std::string& name) {
        const auto found = origin.find(name);
        return found == origin.end() ? std::string("nothing") : found->second;
    };
    std::map<std::string, std::string> all = library.origin;
    all.insert(needed.begin(), needed.end());
    for (const auto& [name, any] : all) {
        const std::string made = value_in(library.origin, name), now = value_in(needed, name);
        if (!alike(name, made, now))
            problems.push_back(
                fmt::format("{}: was made with {} = {}, needed is {}", file.string(), name, made, now));
    }
    if (problems.empty()) return;
    problems.push_back(
        "these differences may change the verdict: give another file name for --library; it is created if "
        "missing. Or use the scene and experiment that this library was made with");
    throw InputError(problems);
}

void expect_library_of(const Library& library, const Grid& grid, const LibraryPlan& plan,
                       const std::filesystem::path& file) {
    std::vector<std::string> problems;
    const auto expect = [&](const std::vector<Signature>& list, const std::string& name) {
        if (std::ranges::find(list, name, &Signature::name) == list.end())
            problems.push_back(fmt::format(
                "{}: has no signature of {}: give another file name; it is created if missing. Or leave {} "
                "out of --candidates",
                file.string(), name, name));
    };
    for (const std::string& name : plan.candidates) expect(library.effects, name);
    for (const Nuisance& nuisance : plan.nuisances) expect(library.nuisances, nuisance.name);
    constexpr double alike = 0.1;                       // the diagnosis finds a shifted zero of strain
    const bool by_force = !library.grid.force.empty();  // then the stroke depends on the effects
    if (!by_force && std::abs(library.grid.stroke - grid.stroke) > alike * grid.stroke)
        problems.push_back(fmt::format("{}: was made for a stroke of {:.4g} mm, the experiment has {:.4g} mm",
                                       file.string(), 1e3 * library.grid.stroke, 1e3 * grid.stroke));
    if (!problems.empty()) throw InputError(problems);
}

namespace {

/// Mean top force of the runs, summed over the levels of loading; large forces dominate [N].
double load(const Grid& grid, const Eigen::MatrixXd& baseline) {
    const std::vector<Cell> cells = cells_of(grid);
    double sum = 0;
    for (std::size_t k = 0; k < cells.size(); ++k) {
        const bool top_force = observables()[cells[k].observable].name == "top_force";
        if (!top_force || cells[k].phase != Phase::load) continue;
        const auto forces = baseline.col(static_cast<Eigen::Index>(k)).array().exp();
        const auto known = forces.isFinite();
        sum += known.select(forces, 0).sum() / std::max<double>(1, static_cast<double>(known.count()));
    }
    return sum;
}

}  // namespace

void expect_alike_loads(const Library& library, const Eigen::MatrixXd& baseline,
                        const std::filesystem::path& file) {
    constexpr double alike = 1.6;  // packings of the same kind with grains 2 % larger carry 1.5 times as much
    const double times = load(library.grid, baseline) / load(library.grid, library.baseline);
    if (!(std::max(times, 1 / times) > alike)) return;
    throw InputError(
        fmt::format("{}: at the same displacements the scene carries {:.2f} times the load on this "
                    "experiment's packing that it "
                    "carries on the library's packings, so the effects differ: leave out "
                    "--library, or give another "
                    "file, made where the plate starts as near to the grains",
                    file.string(), times));
}

}  // namespace mcdem::ensemble
