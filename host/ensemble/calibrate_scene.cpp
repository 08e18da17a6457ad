#include "ensemble/calibrate_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/errors.h"
#include "core/names.h"
#include "core/parameters.h"
#include "ensemble/diagnosis/diagnosis_plan.h"
#include "ensemble/make_packings.h"
#include "experiment/experiment.h"
#include "metrics/top_force.h"
#include "scene/packing/packing_fields.h"
#include "scene/programme/legs.h"

namespace mcdem::inline ensemble {
namespace {

const std::set<std::string> left_aside{"contact.model", "contact.gamma", "packing.seed"};

/// Runs all values and all packings in one simulation, to fill the device.
class ValueBatch {
public:
    ValueBatch(Device& device, const Scene& scene, ContactModel model, double displacement)
        : device_(device), scene_(scene), displacement_(displacement) {
        scene_.replicas = calibration_replicas(scene, model);
        scene_.output.positions = scene_.output.contacts = false;
        packings_ = make_packings(scene_);
    }

    std::size_t replicas() const { return packings_.size(); }
    double stroke() const { return scene_.replicas.front().plate.start - scene_.replicas.front().plate.end; }

    /// Mean top force at the displacement for each value [N]; NaN if it ran away.
    std::vector<double> top_forces(const std::vector<double>& values,
                                   const std::function<void(double)>& on_progress) {
        const auto recordings = simulate_all(values, on_progress);
        std::vector<double> forces;
        for (std::size_t g = 0; g < values.size(); ++g) {
            Replicas replicas;
            for (std::size_t r = 0; r < packings_.size(); ++r)
                replicas.push_back(&recordings[g * packings_.size() + r]);
            const Estimate mean = mean_top_force(replicas);
            if (mean.available()) last_ = mean;
            forces.push_back(mean.value);
        }
        return forces;
    }

    /// For the last value that did not run away.
    const Estimate& last_top_force() const { return last_; }

private:
    std::vector<Recording> simulate_all(const std::vector<double>& values,
                                        const std::function<void(double)>& on_progress) {
        Scene batch = scene_;
        batch.replicas.clear();
        std::vector<Packing> packings;
        for (const double value : values)
            for (std::size_t r = 0; r < packings_.size(); ++r) {
                batch.replicas.push_back(scene_.replicas[r]);
                set(batch.replicas.back(), value);
                packings.push_back(packings_[r]);
            }
        // The last unloading is not evaluated; the simulation may be one interval into it when it stops.
        const auto& protocol = scene_.replicas.front().protocol;
        const int strokes = 2 * protocol.cycles - 1;
        return simulate(
            device_, batch, packings,
            std::size_t(strokes) * protocol.scans_per_stroke + protocol.scan_at_start,
            [&](double fraction) { on_progress(std::min(1.0, fraction * (strokes + 1) / strokes)); });
    }

    static void set(Replica& replica, double value) {
        if (replica.contact.model == ContactModel::mc_dem)
            replica.contact.gamma = value;
        else
            replica.grains.youngs_modulus *= value;
    }

    Estimate mean_top_force(const Replicas& replicas) const {
        const auto forces = top_force_at(group_levels(replicas), replicas, displacement_);
        const auto mean = mean_over_replicas(forces.value);
        return 2 * std::size_t(mean.count) > replicas.size() ? mean : Estimate{};
    }

    Device& device_;
    Scene scene_;
    double displacement_;
    std::vector<Packing> packings_;
    Estimate last_;
};

/// Materials that the reference states and the scene does not have: the calibrated parameter would make up
/// for them.
void note_other_materials(const Scene& scene, const Replicas& reference, const CalibrateOptions& options) {
    std::map<std::string, double> stated;
    for (const std::string& key : material_keys())
        if (const auto value = to_number(value_of(reference.front()->parameters, key))) stated[key] = *value;
    if (options.model != ContactModel::mc_dem) stated.erase("grains.youngs_modulus");  // it is searched for
    if (const auto others = other_materials(scene.replicas.front(), stated); !others.empty())
        options.on_note(
            fmt::format("the reference has {}: the calibrated value makes up for the difference; change the "
                        "scene with --set if the reference is right",
                        fmt::join(others, ", ")));
}

}  // namespace

std::vector<Replica> calibration_replicas(const Scene& scene, ContactModel model) {
    std::vector<std::string> problems;
    for (const auto& key : keys_that_vary(scene.replicas))
        if (!left_aside.contains(key))
            problems.push_back(fmt::format(
                "calibrate: {} must be the same for all replicas: give one value with --set {}=..", key,
                key));
    if (!problems.empty()) throw InputError(problems);
    std::vector<Replica> chosen;
    std::set<std::uint64_t> seeds;
    for (Replica replica : scene.replicas) {
        if (!seeds.insert(replica.packing.seed).second) continue;
        replica.contact.model = model;
        chosen.push_back(std::move(replica));
    }
    return chosen;
}

double SceneCalibration::standard_error() const {
    double variance = found.standard_error * found.standard_error;
    for (const Estimate* force : {&target, &simulated})
        if (std::isfinite(force->standard_error))
            variance += std::pow(force->standard_error / found.slope, 2);
    return std::sqrt(variance);
}

bool SceneCalibration::knows_scatter() const {
    return std::isfinite(target.standard_error) && std::isfinite(simulated.standard_error);
}

SceneCalibration calibrate_scene(Device& device, const Scene& scene, const Replicas& reference,
                                 const CalibrateOptions& options) {
    expect_plain_strokes(scene, "a calibration");
    if (!reference.empty()) note_other_materials(scene, reference, options);
    const auto reference_levels = group_levels(reference);
    SceneCalibration result;
    result.displacement = full_stroke(reference_levels, reference);
    if (!std::isfinite(result.displacement))
        throw InputError(
            "calibrate: the reference must have a scan, got none (all cycles discarded, or all "
            "replicas failed)");
    result.target = mean_over_replicas(top_force_at(reference_levels, reference, result.displacement).value);
    ValueBatch batch(device, scene, options.model, result.displacement);
    if (batch.stroke() < result.displacement - level_tolerance)
        throw InputError(
            fmt::format("calibrate: plate.start - plate.end must reach the reference's greatest "
                        "displacement of {:.3f} mm, got {:.3f} mm",
                        result.displacement * 1e3, batch.stroke() * 1e3));
    result.replicas = static_cast<int>(batch.replicas());
    int round = 0;
    const auto top_forces = [&](const std::vector<double>& values) {
        const auto forces =
            batch.top_forces(values, [&](double fraction) { options.on_progress(round, fraction); });
        ++round;
        return forces;
    };
    CalibrationOptions search = options.search;
    if (options.model != ContactModel::mc_dem) {
        result.youngs_modulus = scene.replicas.front().grains.youngs_modulus;
        search.what = "E over the scene's";
    }
    result.found = calibrate_gamma(top_forces, result.target.value, options.bracket, search);
    result.simulated = batch.last_top_force();
    return result;
}

std::string calibration_json(const SceneCalibration& result, ContactModel model, const Scene& scene,
                             const std::string& reference, const std::string& program) {
    nlohmann::json json;  // writes null for NaN
    const std::string key = result.key();
    const double unit = result.unit();
    json["contact_model"] = name(model);
    json[key] = unit * result.found.gamma;
    json[key + "_standard_error"] = unit * result.standard_error();
    json[key + "_standard_error_of_fit"] = unit * result.found.standard_error;
    json["converged"] = result.found.converged;
    json["runs_away_at_" + key] = unit * result.found.runs_away_at;
    json["target_top_force_N"] = result.target.value;
    json["target_standard_error_N"] = result.target.standard_error;
    json["displacement_m"] = result.displacement;
    json["replicas"] = result.replicas;
    json["reference"] = reference;
    json["scene"] = scene.text;
    json["program"] = program;
    for (const auto& round : result.found.rounds) {
        std::vector<double> tried = round.gamma;
        for (double& value : tried) value *= unit;
        json["rounds"].push_back({{key, tried},
                                  {"top_force_N", round.top_force},
                                  {"estimate", unit * round.root},
                                  {"standard_error", unit * round.standard_error}});
    }
    return json.dump(2) + "\n";
}

ContactModel calibrated_model(const std::string& model, const std::string& option) {
    if (const auto known = parse<ContactModel>(model)) return *known;
    throw InputError(
        fmt::format("{} must be one of {}, got \"{}\"", option, all_names<ContactModel>(), model));
}

}  // namespace mcdem::ensemble
