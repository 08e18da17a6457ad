#include "sim/authors_packing.h"

#include <cmath>

#include "reference/test_scene.h"
#include "scene/packing/make_packing.h"
#include "scene/packing/read_packing.h"
#include "sim/simulation.h"

namespace mcdem::reference {

using namespace mcdem;

Replica authors_replica(ContactModel model, int scans_per_stroke) {
    Replica replica;  // the defaults are those of the experiment
    replica.contact.model = model;
    replica.contact.friction_law = FrictionLaw::mindlin_displacement;
    replica.plate.speed = (replica.plate.start - replica.plate.end) / 0.3;
    replica.protocol.scans_per_stroke = scans_per_stroke;
    replica.protocol.rate_tolerance = 0;
    replica.protocol.relax_time = 0;
    return replica;
}

namespace {

struct StrokeBatch {
    Scene scene;
    std::vector<Packing> packings;
    std::vector<std::string> names;  ///< name of the setting of each replica
};

std::map<Precision, StrokeBatch> batches(const std::map<std::string, Setting>& settings, int replicas) {
    const Packing start = read_packing(authors_folder / "input.data");
    std::map<Precision, StrokeBatch> all;
    for (const auto& [name, setting] : settings)
        for (int seed = 1; seed <= replicas; ++seed) {
            auto& batch = all[setting.precision];
            batch.scene.precision = setting.precision;
            batch.scene.output = {false, false, 1};
            batch.scene.replicas.push_back(setting.replica);
            batch.packings.push_back(start);
            if (replicas > 1) apply_jitter(batch.packings.back(), 1e-4, seed);
            batch.names.push_back(name);
        }
    return all;
}

/// Top force of each replica until all have finished loading; shorter if a replica failed.
std::vector<Curve> load(const StrokeBatch& batch) {
    std::vector<Curve> curves(batch.names.size());
    std::size_t under_way = curves.size();
    Simulation simulation(device(), batch.scene, batch.packings);
    const auto take = [&](int r, const Scan& scan) {
        if (scan.phase == Phase::unload) return;
        curves[r].push_back(scan.top_force());
        if (static_cast<int>(curves[r].size()) == batch.scene.replicas[r].protocol.scans_per_stroke)
            --under_way;
    };
    const auto fail = [&](int r, const Failure& failure) {
        ADD_FAILURE() << batch.names[r] << " stopped at step " << failure.step << ": " << failure.cause;
        --under_way;
    };
    while (under_way > 0 && simulation.advance(take, fail)) {
    }
    return curves;
}

MeanCurve mean_curve(const std::vector<const Curve*>& curves) {
    MeanCurve result;
    result.replicas = static_cast<int>(curves.size());
    const double n = result.replicas;
    for (std::size_t k = 0; k < curves[0]->size(); ++k) {
        double sum = 0, squares = 0;
        for (const auto* curve : curves) sum += (*curve)[k];
        for (const auto* curve : curves) squares += std::pow((*curve)[k] - sum / n, 2);
        result.mean.push_back(sum / n);
        result.standard_error.push_back(n > 1 ? std::sqrt(squares / (n - 1) / n) : 0);
    }
    return result;
}

}  // namespace

std::map<std::string, MeanCurve> loading_strokes(const std::map<std::string, Setting>& settings,
                                                 int replicas) {
    std::map<std::string, std::vector<const Curve*>> by_name;
    std::vector<std::vector<Curve>> kept;
    kept.reserve(2);  // no reallocation: the curves must not move
    for (const auto& [precision, batch] : batches(settings, replicas)) {
        kept.push_back(load(batch));
        for (std::size_t r = 0; r < batch.names.size(); ++r)
            if (static_cast<int>(kept.back()[r].size()) == batch.scene.replicas[r].protocol.scans_per_stroke)
                by_name[batch.names[r]].push_back(&kept.back()[r]);
    }
    std::map<std::string, MeanCurve> means;
    for (const auto& [name, curves] : by_name) means[name] = mean_curve(curves);
    return means;
}

}  // namespace mcdem::reference
