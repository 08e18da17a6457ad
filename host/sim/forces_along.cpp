#include "sim/forces_along.h"

#include <fmt/format.h>

#include <cmath>

#include "core/errors.h"
#include "scene/packing/make_packing.h"
#include "scene/packing/true_grains.h"
#include "sim/batch_limits.h"
#include "sim/device_replica.h"

namespace mcdem::inline sim {
namespace {

std::string at(const char* what, std::size_t row, std::size_t grain) {
    return fmt::format("{}[{}, {}]", what, row, grain);
}

class PathCheck {
public:
    PathCheck(const Replica& replica, const Packing& packing)
        : box_(replica.box),
          plate_(plate_face(replica, replica.plate.start)),
          packing_(packing),
          margin_(0.5 * replica.numerics.skin * mean_radius(packing)) {}

    void check(const std::vector<double>& time, const std::vector<GrainMotion>& path) {
        if (time.empty()) problems_.emplace_back("time: must have at least 1 value, got none");
        for (std::size_t row = 0; row < time.size() && problems_.size() < max_problems; ++row) {
            check_time(time, row);
            check_row(path, row);
        }
        if (!problems_.empty()) throw InputError(problems_);
    }

private:
    static constexpr std::size_t max_problems = 10;

    void check_time(const std::vector<double>& time, std::size_t row) {
        if (!std::isfinite(time[row]))
            problems_.push_back(fmt::format("time[{}]: must be finite [s], got {}", row, time[row]));
        else if (row > 0 && !(time[row] - time[row - 1] >= min_time_step))
            problems_.push_back(fmt::format("time[{}]: must be at least {} s after time[{}], got {} after {}",
                                            row, min_time_step, row - 1, time[row], time[row - 1]));
    }

    void check_row(const std::vector<GrainMotion>& path, std::size_t row) {
        const GrainMotion& now = path[row];
        for (std::size_t i = 0; i < packing_.size(); ++i) {
            expect_finite(at("position", row, i), now.position[i]);
            expect_finite(at("velocity", row, i), now.velocity[i]);
            expect_finite(at("spin", row, i), now.angular_velocity[i]);
            if (row == 0) continue;
            const double way = (now.position[i] - path[row - 1].position[i]).norm();
            if (way > margin_)
                problems_.push_back(
                    fmt::format("{}: must be at most {:.6g} m from the row before, half of numerics.skin "
                                "times the mean radius, got {:.6g} m: take shorter steps",
                                at("position", row, i), margin_, way));
        }
        packing_.position = now.position;
        if (problems_.empty())
            problems_ = packing_problems(packing_, box_, plate_, fmt::format("position[{}]", row));
    }

    void expect_finite(const std::string& where, const Vec3& vector) {
        if (!vector.allFinite())
            problems_.push_back(
                fmt::format("{}: must be finite, got {}, {}, {}", where, vector.x(), vector.y(), vector.z()));
    }

    Box box_;
    PlateFace plate_;
    Packing packing_;
    double margin_;  ///< [m]
    std::vector<std::string> problems_;
};

void expect_one_packing(const Scene& scene) {
    if (scene.replicas.size() != 1)
        throw InputError(
            fmt::format("the scene must have one replica, got {}: leave [batch] out", scene.replicas.size()));
    const double rolling = scene.replicas.front().effects.rolling_resistance;
    if (rolling != 0)
        throw InputError(fmt::format(
            "effects.rolling_resistance: must be 0 here, got {}: its couples are not among the forces of "
            "contacts",
            rolling));
}

void expect_sound(const GrainForces& forces, const Scene& scene, std::size_t row) {
    const Numerics& numerics = scene.replicas.front().numerics;
    const auto refuse = [&](const std::string& what) {
        throw InputError(fmt::format("row {} of the path: {}", row, what));
    };
    if (forces.status & STATUS_SLOTS)
        refuse(fmt::format("a grain has more than {} near neighbours (raise numerics.slots)", scene.slots));
    if (forces.status & STATUS_UNPROBED)
        refuse("a free surface moved out by more than numerics.probe_gap (raise it)");
    if (forces.status & STATUS_OVERLAP || !(forces.deepest_overlap <= numerics.overlap_limit))
        refuse(fmt::format("a corrected overlap passed {} of the sum of the radii (numerics.overlap_limit)",
                           numerics.overlap_limit));
}

}  // namespace

std::vector<GrainForces> forces_along(Device& device, const Scene& scene, Packing packing,
                                      const std::vector<double>& time, const std::vector<GrainMotion>& path,
                                      const StopWanted& stop_wanted) {
    expect_one_packing(scene);
    const Replica& replica = scene.replicas.front();
    packing = true_packing(replica, std::move(packing));
    expect_room(replica, packing);
    PathCheck(replica, packing).check(time, path);
    packing.position = path.front().position;
    packing.velocity.clear(), packing.angular_velocity.clear();
    Engine engine(device, kernel_build(device, scene.precision, scene.slots), {replica}, {packing});
    std::vector<GrainForces> forces;
    for (std::size_t row = 0; row < time.size(); ++row) {
        if (stop_wanted()) throw Interrupted();
        forces.push_back(engine.forces_at(0, path[row], row == 0 ? 0 : time[row] - time[row - 1]));
        expect_sound(forces.back(), scene, row);
    }
    return forces;
}

}  // namespace mcdem::sim
