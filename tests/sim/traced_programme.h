// Runs a programme on a packing and records, at the end of each interval, the plate's position and force, or
// the strain and stress of a cell.
#pragma once
#include "reference/test_scene.h"
#include "scene/packing/make_packing.h"
#include "scene/read/read_scene.h"
#include "sim/compliant_plate.h"
#include "sim/simulation.h"

namespace mcdem::reference {

struct Traced {
    struct Row {
        double time, plate_z, force;  ///< [s], [m], [N]
        int leg;
        mcdem::Activity activity;
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

/// One grain of 10 mm radius between two almost rigid walls.
inline Traced trace_one_grain(const std::string& text) {
    mcdem::Scene scene = mcdem::parse_scene(R"([box]
size_x = 0.021
size_y = 0.021
[packing]
count = 1
diameter_mean = 0.02
diameter_sd = 0
diameter_min = 0.02
diameter_max = 0.02
packing_fraction = 0.45
[plate]
start = 0.0215
end = 0.015
[grains]
excess_density = 0
[walls]
youngs_modulus = 1e13
[contact]
model = "independent"
)" + text,
                                            "grain.toml");
    scene.precision = finest();
    return trace(scene, 0, {{{0.0105, 0.0105, 0.01}}, {0.02}});
}

}  // namespace mcdem::reference
