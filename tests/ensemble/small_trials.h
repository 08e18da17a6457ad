// Trials that run quickly: a few dozen grains, three scans.
#pragma once
#include "ensemble/diagnosis/library_trials.h"
#include "ensemble/make_packings.h"
#include "ensemble/small_scene.h"

namespace mcdem {

struct SmallTrials {
    SmallTrials() {
        Scene scene = small_scene({"packing.count=18", "packing.packing_fraction=0.52", "plate.start=0.06",
                                   "plate.end=0.05", "protocol.scans_per_stroke=3",
                                   "protocol.stop_at_scans=false", "contact.friction_law=saturated"});
        scene.replicas.resize(1);
        packing = make_packings(scene).front();
        model.replica = scene.replicas.front();
        model.mean_diameter = 0.0215;
        model.instrument.stated = {1e-5, 1e-5, 0.01, 1e-4};
        common = {scene, Grid{{0.0066, 0.0098}, 0.005, 0.01}, reference_material(model), 0, "test"};
    }

    Trial trial(std::uint64_t seed = 1) const { return {model, packing, 1e-5, 1e-5, seed}; }

    Model model;
    Packing packing;
    TrialSettings common;
    TestFolder folder;
    ObservationStore store{folder.path / "simulations"};
};

/// True if all bits are equal; any two NaN are equal.
inline bool same(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    if (a.size() != b.size()) return false;
    for (Eigen::Index k = 0; k < a.size(); ++k)
        if (a[k] != b[k] && !(std::isnan(a[k]) && std::isnan(b[k]))) return false;
    return true;
}

inline long files_in(const std::filesystem::path& folder) {
    return std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator());
}

}  // namespace mcdem
