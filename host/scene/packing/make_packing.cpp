#include "scene/packing/make_packing.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "core/container.h"
#include "core/errors.h"
#include "core/median.h"
#include "core/random.h"
#include "scene/packing/generate_packing.h"
#include "scene/programme/cell_path.h"
#include "scene/read/resolve_species.h"

namespace mcdem::inline scene {
namespace {

constexpr std::size_t max_outside = 10;

std::string described(const Box& box) {
    if (is_cylinder(box)) return fmt::format("cylinder of radius {} m", cylinder_radius(box));
    return fmt::format("box of {} x {} m", box.size_x, box.size_y);
}

bool is_inside(const Box& box, const PlateFace& plate, const Vec3& point) {
    if (is_cell(box)) return point.allFinite();
    if (!(point.z() >= 0 && point.z() <= plate.height(point))) return false;
    if (is_periodic(box)) return point.allFinite();
    for (const Wall wall : {Wall::x_min, Wall::x_max, Wall::y_min, Wall::y_max})
        if (has_wall(box, wall) && !(wall_distance(box, wall, plate.z, point) >= 0)) return false;
    return true;
}

}  // namespace

double list_reach(const Numerics& numerics, double mean_diameter, double largest_diameter) {
    return largest_diameter + (numerics.probe_gap + numerics.skin) * mean_diameter / 2;
}

std::optional<TooSmall> too_small_container(const Box& box, const Numerics& numerics, double mean_diameter,
                                            double largest_diameter) {
    if (is_cylinder(box) && !(cylinder_radius(box) >= largest_diameter))
        return TooSmall{"container.radius",
                        fmt::format("must be at least the largest diameter of its grains, {:.6g} m, got "
                                    "{}: Hertz's contact does not hold in a narrower cylinder",
                                    largest_diameter, cylinder_radius(box))};
    if (!is_periodic(box)) return std::nullopt;
    const double reach = list_reach(numerics, mean_diameter, largest_diameter);
    std::pair<const char*, double> shortest{"container.size_x", box.size_x};
    if (box.size_y <= shortest.second) shortest = {"container.size_y", box.size_y};
    if (is_cell(box) && box.height < shortest.second) shortest = {"container.height", box.height};
    if (shortest.second >= 2 * reach) return std::nullopt;
    return TooSmall{
        shortest.first,
        fmt::format(
            "must be at least {:.6g} m in a container that repeats{}, got {}: two grains could meet "
            "twice, over both of its ends; take a {} one, or lower numerics.skin or numerics.probe_gap",
            2 * reach, is_cell(box) ? " at its smallest" : "", shortest.second,
            is_cell(box) ? "larger" : "wider")};
}

void expect_room(const Replica& replica, const Packing& packing) {
    if (packing.size() == 0) return;
    const double mean = std::accumulate(packing.diameter.begin(), packing.diameter.end(), 0.0) /
                        static_cast<double>(packing.size());
    if (const auto small = too_small_container(smallest_cell(replica), replica.numerics, mean,
                                               *std::ranges::max_element(packing.diameter)))
        throw InputError(fmt::format("{} {}{}", small->key, small->what,
                                     replica.label.empty() ? "" : fmt::format(" ({})", replica.label)));
}

void apply_jitter(Packing& packing, double sd, std::uint64_t seed) {
    if (sd == 0) return;
    Random random(seed, Stream::jitter);
    for (Vec3& position : packing.position)
        for (int axis = 0; axis < 3; ++axis) position[axis] += sd * random.normal();
}

std::vector<std::string> packing_problems(const Packing& packing, const Box& box, const PlateFace& plate,
                                          const std::string& source) {
    if (packing.size() == 0)
        return {fmt::format("{}: a packing must have at least 1 grain, got none", source)};
    const double widest = std::min(box.size_x, box.size_y);
    const double typical = median(packing.diameter);
    if (typical > widest)
        return {fmt::format("{}: lengths must be in metres and fit the {}, got a median diameter of {}{}",
                            source, described(box), typical,
                            typical * 1e-3 <= widest ? "; millimetres? divide by 1000" : "")};
    Vec3 low = packing.position.front(), high = low;
    for (const Vec3& p : packing.position) low = low.cwiseMin(p), high = high.cwiseMax(p);
    const double width = std::max(box.size_x, box.size_y);
    if (width > widest_box && width * 1e-3 >= typical && (high - low).maxCoeff() + typical < 0.01 * width)
        return {
            fmt::format("{}: the box must be in metres and fit the packing, {:.3g} m wide, got {} x {} m: "
                        "divide box.size_x and "
                        "box.size_y by 1000 if they are in millimetres",
                        source, (high - low).head<2>().maxCoeff() + typical, box.size_x, box.size_y)};
    std::vector<std::string> problems;
    std::size_t outside = 0;
    for (std::size_t i = 0; i < packing.size(); ++i) {
        const Vec3& p = packing.position[i];
        if (is_inside(box, plate, p) || ++outside > max_outside) continue;
        problems.push_back(
            fmt::format("{}: the centre of grain {} must be in the {} below the plate at {} m, "
                        "got {}, {}, {}",
                        source, i, described(box), plate.height(p), p.x(), p.y(), p.z()));
    }
    if (outside > max_outside)
        problems.push_back(fmt::format("{}: .. and {} more grains outside", source, outside - max_outside));
    return problems;
}

PackingSize size_of(const Packing& packing) {
    PackingSize size{packing.size(), packing.size() == 0 ? 0 : *std::ranges::min_element(packing.diameter)};
    for (const Vec3& velocity : packing.velocity) size.fastest = std::max(size.fastest, velocity.norm());
    for (std::size_t i = 0; i < packing.angular_velocity.size(); ++i)
        size.fastest = std::max(size.fastest, packing.diameter[i] / 2 * packing.angular_velocity[i].norm());
    return size;
}

std::vector<PackingSize> packing_sizes(const std::vector<Replica>& replicas) {
    std::vector<PackingSize> sizes;
    std::map<std::pair<std::string, std::optional<long>>, PackingSize> files;
    for (const Replica& replica : replicas) {
        if (const auto* drawn = std::get_if<GeneratedPacking>(&replica.packing.source)) {
            sizes.push_back({static_cast<std::size_t>(drawn->count), drawn->diameter_min});
            continue;
        }
        const auto& file = std::get<PackingFile>(replica.packing.source);
        const auto [known, is_new] = files.try_emplace({file.path, file.step});
        if (is_new) known->second = size_of(file.read());
        sizes.push_back(known->second);
    }
    return sizes;
}

Packing make_packing(const Replica& replica) {
    const PackingSource& from = replica.packing;
    Packing packing;
    std::string source = "generated packing";
    if (const auto* file = std::get_if<PackingFile>(&from.source)) {
        packing = file->read();
        source = file->path;
        assign_species(packing, replica, source);
    } else {
        packing = generate_packing(std::get<GeneratedPacking>(from.source), replica.box, from.seed,
                                   mixture_of(replica));
    }
    apply_jitter(packing, from.position_jitter, from.seed);
    // A generated packing may be slightly higher than the plate, but centres are never above it.
    const auto problems =
        packing_problems(packing, replica.box, plate_face(replica, replica.plate.start), source);
    if (!problems.empty()) throw InputError(problems);
    for (Vec3& position : packing.position) position = into_cell(replica.box, position);
    return packing;
}

}  // namespace mcdem::scene
