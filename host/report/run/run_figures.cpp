#include "report/run/run_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "metrics/coordination.h"
#include "metrics/programmes.h"
#include "metrics/scaling.h"
#include "report/page/labels.h"

namespace mcdem::inline report {
namespace {

constexpr double mN_m = 1e-3;
constexpr std::size_t key_characters = 44;  ///< longer labels would leave no space for the curves

std::optional<Comparison> comparison_of(const Setting& setting, const std::optional<Setting>& reference,
                                        const FigureOptions& options) {
    if (!reference) return std::nullopt;
    for (const auto& comparison : options.comparisons)
        if (comparison.setting == setting.label) return comparison;
    return compare(setting, reference->replicas, options.touch_force);
}

std::string key_words(const Setting& setting) { return shortened(words_for(setting.label), key_characters); }

bool is_programme(const Series& series) { return follows_programme(series.setting.replicas); }

void add_each(const FigureData& data, RunFigure& figure,
              const std::function<FigureSeries(const Series&)>& make) {
    const auto add = [&](const Series& series) {
        if (is_programme(series)) return;  // a programme has no levels
        auto shown = make(series);
        if (!shown.curves.empty()) figure.series.push_back(std::move(shown));
    };
    for (const auto& series : data.simulated) add(series);
    if (data.reference) add(*data.reference);
}

/// The known levels of one phase. Unloading starts at the turning point, the last level of loading, which is
/// then last.
std::vector<FigurePoint> curve_points(const std::vector<LevelMean>& means, Phase phase) {
    std::vector<FigurePoint> points;
    const auto point_of = [](const LevelMean& level) -> FigurePoint {
        return {level.displacement / mm, level.mean.value, level.mean.standard_error};
    };
    const LevelMean* turning = nullptr;
    for (const auto& level : means) {
        if (!level.mean.available()) continue;
        if (level.phase == Phase::load) turning = &level;
        if (level.phase == phase) points.push_back(point_of(level));
    }
    if (phase == Phase::unload && turning && !points.empty() && turning->displacement / mm > points.back().x)
        points.push_back(point_of(*turning));
    return points;
}

std::vector<FigureCurve> curves_of(const std::function<std::vector<FigurePoint>(Phase)>& points_of) {
    std::vector<FigureCurve> curves;
    for (const Phase phase : {Phase::load, Phase::unload})
        if (auto points = points_of(phase); !points.empty()) curves.push_back({phase, std::move(points)});
    return curves;
}

std::vector<FigureCurve> curves_of(const std::vector<LevelMean>& means) {
    return curves_of([&](Phase phase) { return curve_points(means, phase); });
}

RunFigure top_force_figure(const FigureData& data) {
    RunFigure figure{"top_force", "plate displacement [mm]", "top force [N]", {}, {}};
    add_each(data, figure, [](const Series& series) -> FigureSeries {
        const bool known = series.comparison && series.comparison->Rtop.available();
        return {&series, known ? fmt::format("Rtop {:.2f}", series.comparison->Rtop.value) : "",
                curves_of(level_means(series.levels, top_force))};
    });
    return figure;
}

/// p(f) of one series at the level nearest to the requested one.
struct ShownDensity {
    const Series* series;
    const Level* level;
    ForceDensity density;
};

double distance(const Level& level, const FigureOptions& options) {
    return std::abs(level.displacement - options.distribution_displacement);
}

/// The level with contacts nearest to the displacement in this phase; null if there is none.
const Level* nearest_level(const Series& series, const FigureOptions& options, Phase phase) {
    const Level* nearest = nullptr;
    for (const auto& level : series.levels) {
        bool known = false;
        for (const auto& scans : level.scans)
            for (const auto* scan : scans) known = known || !scan->contacts.empty();
        if (level.phase == phase && known &&
            (!nearest || distance(level, options) < distance(*nearest, options)))
            nearest = &level;
    }
    return nearest;
}

/// In this phase; in the other one if this one has no contacts, as unloading of runs that stopped early.
const Level* nearest_level_if_any(const Series& series, const FigureOptions& options, Phase phase) {
    const Level* level = nearest_level(series, options, phase);
    return level ? level : nearest_level(series, options, phase == Phase::load ? Phase::unload : Phase::load);
}

/// Unloading, unless the first series was loaded nearer to the displacement, as at the turning point.
Phase shown_phase(const FigureData& data, const FigureOptions& options) {
    const Series* first = !data.simulated.empty() ? &data.simulated.front()
                          : data.reference        ? &*data.reference
                                                  : nullptr;
    if (!first) return Phase::unload;
    const Level *load = nearest_level(*first, options, Phase::load),
                *unload = nearest_level(*first, options, Phase::unload);
    constexpr double alike = 1e-6;  // [m]
    const bool is_nearer = load && unload && distance(*load, options) < distance(*unload, options) - alike;
    return is_nearer ? Phase::load : Phase::unload;
}

std::vector<ShownDensity> shown_levels(const FigureData& data, const FigureOptions& options) {
    const Phase phase = shown_phase(data, options);
    std::vector<ShownDensity> shown;
    for (const auto& series : data.simulated)
        shown.push_back({&series, nearest_level_if_any(series, options, phase), {}});
    if (data.reference)
        shown.push_back({&*data.reference, nearest_level_if_any(*data.reference, options, phase), {}});
    std::erase_if(shown, [](const ShownDensity& s) { return !s.level; });
    return shown;
}

/// Common bins up to a force that few contacts exceed; their number follows from the smallest sample.
struct Bins {
    double largest = 0;  ///< [N]
    int count = 100;
};
Bins common_bins(const std::vector<ShownDensity>& shown) {
    Bins bins;
    for (const auto& [series, level, density] : shown) {
        std::vector<double> forces;
        for (const auto& scans : level->scans) {
            const auto of_replica = contact_forces(scans).grain_grain;
            forces.insert(forces.end(), of_replica.begin(), of_replica.end());
        }
        if (forces.empty()) continue;
        std::ranges::sort(forces);
        bins.largest = std::max(bins.largest, forces[(forces.size() - 1) * 999 / 1000]);
        const auto contacts = static_cast<double>(forces.size());
        bins.count = std::min(bins.count, std::clamp(bin_count(contacts, contacts), 8, 30));
    }
    return bins;
}

/// In common bins, up to a force that few contacts exceed; empty without data.
std::vector<ShownDensity> shown_densities(const FigureData& data, const FigureOptions& options) {
    auto shown = shown_levels(data, options);
    const auto bins = common_bins(shown);
    if (!(bins.largest > 0)) return {};
    for (auto& one : shown) one.density = force_density(*one.level, bins.count, bins.largest);
    return shown;
}

RunFigure distribution_figure(const FigureData& data, const FigureOptions& options) {
    RunFigure figure{"force_distribution", "contact force f [mN]", "density p(f) [1/mN]", {}, {}};
    for (const auto& [series, level, density] : shown_densities(data, options)) {
        figure.displacement = figure.displacement.value_or(level->displacement / mm);
        std::vector<FigurePoint> points;
        for (std::size_t b = 0; b < density.force.size(); ++b)
            if (density.density[b].value > 0)  // the logarithm of an empty bin cannot be drawn
                points.push_back({density.force[b] / mN, density.density[b].value * mN,
                                  density.density[b].standard_error * mN});
        if (!points.empty()) figure.series.push_back({series, "", {{level->phase, std::move(points)}}});
    }
    return figure;
}

/// Force threshold of Z [N], if weaker forces are left out.
std::optional<double> threshold_of(const Series& series, const FigureOptions& options) {
    if (series.comparison)
        return series.comparison->tau.available() ? std::optional(series.comparison->tau.value)
                                                  : std::nullopt;
    return options.threshold > 0 ? std::optional(options.threshold) : std::nullopt;
}

/// Z of the series at its threshold; as recorded without contacts, and for the reference.
std::vector<LevelMean> coordination_means(const FigureData& data, const Series& series,
                                          const FigureOptions& options) {
    Eigen::ArrayXXd z = reference_coordination(series.levels, series.setting.replicas);
    if (const Coordination counted(series.levels, series.setting.replicas);
        !data.is_reference(series) && counted.known())
        z = counted.at_threshold(threshold_of(series, options).value_or(0));
    return level_means(series.levels, z);
}

RunFigure coordination_figure(const FigureData& data, const FigureOptions& options) {
    RunFigure figure{"coordination", "plate displacement [mm]", "contacts per grain Z", {}, {}};
    add_each(data, figure, [&](const Series& series) -> FigureSeries {
        const auto tau = data.is_reference(series) ? std::nullopt : threshold_of(series, options);
        return {&series, tau ? fmt::format("tau {:.2f} mN", *tau / mN) : "",
                curves_of(coordination_means(data, series, options))};
    });
    return figure;
}

RunFigure scaling_figure(const FigureData& data) {
    RunFigure figure{"scaling", "⟨Z⟩⟨φ⟩⟨b⟩⟨f⟩ [mN m]", "top force F [N]", {}, {}};
    add_each(data, figure, [](const Series& series) -> FigureSeries {
        const auto all = scaling_points(series.levels);
        if (std::ranges::none_of(all, [](const ScalingPoint& p) { return p.product.value > 0; }))
            return {&series, "", {}};
        const auto points_of = [&](Phase phase) {
            std::vector<FigurePoint> points;
            for (const auto& p : all)
                if (p.phase == phase)
                    points.push_back({p.product.value / mN_m, p.top_force.value, p.top_force.standard_error});
            return points;
        };
        const double slope = fit_scaling(all).coefficient;
        return {&series, fmt::format("{:.0f} /m", slope), curves_of(points_of), slope * mN_m};
    });
    return figure;
}

constexpr double distortion = 1e-6;  ///< smaller deviatoric strains of a cell are ignored

struct Axis {
    std::string label;
    double unit;
    Estimate MeanScan::*of;
};

/// Scans of one setting.
struct Track {
    const Series* series;
    std::vector<MeanScan> scans;
};

std::vector<Track> tracks_of(const FigureData& data, bool cells) {
    std::vector<Track> tracks;
    for (const Series& series : data.simulated)
        if (const auto& replicas = series.setting.replicas;
            follows_programme(replicas) && are_cells(replicas) == cells)
            tracks.push_back({&series, mean_scans(replicas)});
    return tracks;
}

/// Nothing without data.
void add_figure(std::vector<RunFigure>& figures, const std::vector<Track>& tracks, const std::string& name,
                const std::string& title, const Axis& x, const Axis& y) {
    RunFigure figure{name, x.label, y.label, {}, {}, title};
    for (const Track& track : tracks) {
        std::vector<FigurePoint> points;
        for (const MeanScan& scan : track.scans) {
            const Estimate &along = scan.*x.of, &up = scan.*y.of;
            if (along.available() && up.available())
                points.push_back({along.value / x.unit, up.value / y.unit, up.standard_error / y.unit});
        }
        if (!points.empty()) figure.series.push_back({track.series, "", {{Phase::load, std::move(points)}}});
    }
    if (!figure.series.empty()) figures.push_back(std::move(figure));
}

double largest(const std::vector<Track>& tracks, Estimate MeanScan::*quantity) {
    double most = 0;
    for (const Track& track : tracks)
        for (const MeanScan& scan : track.scans) most = std::fmax(most, std::fabs((scan.*quantity).value));
    return most;
}

bool are_distorted(const std::vector<Track>& cells) {
    return largest(cells, &MeanScan::shear_strain) > distortion;
}

const Axis time_axis{"time [s]", 1, &MeanScan::time};
const Axis volume{"volume strain [%]", 1e-2, &MeanScan::volume_strain};
const Axis shear{"deviatoric strain [%]", 1e-2, &MeanScan::shear_strain};

/// Mean and deviatoric stress of the tracks in a common unit.
struct Stresses {
    Axis p, q;
};
Stresses stresses_of(const std::vector<Track>& tracks) {
    const StressUnit unit =
        stress_unit(std::fmax(largest(tracks, &MeanScan::p), largest(tracks, &MeanScan::q)));
    const std::string in = std::string(" [") + unit.name + "]";
    return {{"mean stress p" + in, unit.size, &MeanScan::p},
            {"deviatoric stress q" + in, unit.size, &MeanScan::q}};
}

void add_plates(const std::vector<Track>& tracks, std::vector<RunFigure>& figures) {
    const Axis force{"top force [N]", 1, &MeanScan::top_force};
    const Axis moved{"plate displacement [mm]", 1e-3, &MeanScan::displacement};
    add_figure(figures, tracks, "force_time", "Force on the plate against time", time_axis, force);
    add_figure(figures, tracks, "displacement_time", "Displacement of the plate against time", time_axis,
               moved);
    add_figure(figures, tracks, "force_displacement", "Force on the plate against displacement", moved,
               force);
}

void add_cells(const std::vector<Track>& tracks, std::vector<RunFigure>& figures) {
    const auto [p, q] = stresses_of(tracks);
    add_figure(figures, tracks, "pressure_strain", "Mean stress against volume strain", volume, p);
    if (are_distorted(tracks))
        add_figure(figures, tracks, "shear_stress_strain", "Deviatoric stress against deviatoric strain",
                   shear, q);
    add_figure(figures, tracks, "cell_coordination", "Contacts per grain",
               {"packing fraction φ", 1, &MeanScan::packing_fraction},
               {"contacts per grain Z", 1, &MeanScan::coordination});
}

void add_times_of_cells(const std::vector<Track>& tracks, std::vector<RunFigure>& figures) {
    const auto holds = [](const Track& track) { return has_hold(track.series->setting.replicas); };
    if (std::ranges::none_of(tracks, holds)) return;
    const auto [p, q] = stresses_of(tracks);
    add_figure(figures, tracks, "pressure_time", "Mean stress against time", time_axis, p);
    add_figure(figures, tracks, "volume_time", "Volume strain against time", time_axis, volume);
    if (!are_distorted(tracks)) return;
    add_figure(figures, tracks, "shear_stress_time", "Deviatoric stress against time", time_axis, q);
    add_figure(figures, tracks, "shear_strain_time", "Deviatoric strain against time", time_axis, shear);
}

}  // namespace

bool is_thresholded(const FigureData& data, const FigureOptions& options) {
    return std::ranges::any_of(
        data.simulated, [&](const Series& series) { return threshold_of(series, options).has_value(); });
}

FigureData figure_data(const std::vector<Setting>& settings, const std::optional<Setting>& reference,
                       const FigureOptions& options) {
    FigureData data;
    const auto styles = styles_of(settings);
    for (std::size_t s = 0; s < settings.size(); ++s) {
        const bool programme = follows_programme(settings[s].replicas);
        auto levels = programme ? Levels() : group_levels(settings[s].replicas);
        if (programme || !levels.empty())
            data.simulated.push_back({key_words(settings[s]), styles[s], settings[s], std::move(levels),
                                      comparison_of(settings[s], reference, options)});
    }
    if (reference)
        data.reference = Series{key_words(*reference), reference_style(), *reference,
                                group_levels(reference->replicas), std::nullopt};
    return data;
}

std::vector<RunFigure> programme_figures(const FigureData& data) {
    std::vector<RunFigure> figures;
    const auto plates = tracks_of(data, false), cells = tracks_of(data, true);
    add_plates(plates, figures);
    add_cells(cells, figures);
    auto paths = plates;
    if (are_distorted(cells)) paths.insert(paths.end(), cells.begin(), cells.end());
    const auto [p, q] = stresses_of(paths);
    add_figure(figures, paths, "stress_path", "Stress path", p, q);
    add_times_of_cells(cells, figures);
    return figures;
}

RunFigures run_figures(const FigureData& data, const FigureOptions& options) {
    RunFigures made;
    if (data.simulated.empty()) {
        made.missing.push_back("any quantity: no scans are left after the discarded cycles");
        return made;
    }
    const auto take = [&](RunFigure figure, const char* missing) {
        if (!figure.series.empty())
            made.figures.push_back(std::move(figure));
        else
            made.missing.push_back(missing);
    };
    if (std::ranges::any_of(data.simulated, &is_programme)) {
        for (auto& figure : programme_figures(data)) made.figures.push_back(std::move(figure));
        if (std::ranges::all_of(data.simulated, &is_programme)) return made;
    }
    take(top_force_figure(data), "the top force: it was not recorded");
    take(distribution_figure(data, options), "the force distribution: no contacts were recorded");
    take(coordination_figure(data, options), "Z: contacts per grain were not recorded");
    take(scaling_figure(data), "the scaling law: averages over the packing were not recorded");
    return made;
}

}  // namespace mcdem::report
