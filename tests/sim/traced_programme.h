// Runs a programme on a packing and records, at the end of each interval, the plate's position and force, or
// the strain and stress of a cell.
#pragma once
#include "reference/test_scene.h"
#include "scene/packing/make_packing.h"
#include "scene/read/read_scene.h"
#include "sim/compliant_plate.h"
#include "sim/simulation.h"

namespace reference {

struct Traced {
    struct Row {
        double time, plate_z, force;  ///< [s], [m], [N]
        int leg;
        mcdem::ProtocolState::Activity stage;
        mcdem::Mat3 stress;  ///< of a cell [Pa]
        mcdem::Strain strain;
    };
    struct Scanned {
        mcdem::ProtocolRunner::ScanTag tag;
        double force;  ///< [N]
        mcdem::Mat3 stress;
        mcdem::Strain strain;
        mcdem::ReplicaState state = {};
    };
    std::vector<Row> rows;
    std::vector<Scanned> scans;
    std::string hindrance;
    int status = 0;
};

/// Runs every replica of the scene on its own.
inline Traced trace(const mcdem::Scene& scene, int r, Packing packing) {
    const Replica& replica = scene.replicas[static_cast<std::size_t>(r)];
    Engine engine(device(), build(scene.precision, scene.slots), {replica}, {packing});
    mcdem::ProtocolRunner runner(replica, engine.time_step(0), mcdem::scale_of(replica, packing));
    mcdem::CompliantPlate plate(replica);
    Traced traced;
    while (!runner.finished()) {
        const double dt = engine.time_step(0);
        runner.set_time_step(dt);
        auto interval = runner.next([&](const auto& next) { return engine.max_interval(0, next); });
        const auto before = runner.state();
        plate.deflect(interval, engine.time_step(0, interval), engine.max_plate_move(0));
        const auto result = engine.advance({interval}).front();
        plate.on_interval_done(result);
        const auto scan = runner.on_interval_done(result, plate.arrived(engine.max_plate_move(0)));
        const double force = result.wall_force[static_cast<int>(mcdem::Wall::plate)].z();
        traced.rows.push_back({runner.state().time, runner.plate_z(), force, before.leg, before.activity,
                               result.stress, runner.strain()});
        if (scan) traced.scans.push_back({*scan, force, result.stress, runner.strain(), engine.state(0)});
        traced.status |= result.status;
        if (result.status) break;
    }
    traced.hindrance = runner.hindrance();
    return traced;
}

inline Traced trace(const std::string& text, const std::vector<std::string>& overrides = {}) {
    const auto scene = mcdem::parse_scene(text, "traced.toml", overrides);
    return trace(scene, 0, mcdem::make_packing(scene.replicas[0]));
}

}  // namespace reference
