#include "report/run/programme_figures.h"

#include <algorithm>
#include <cmath>

#include "metrics/programmes.h"
#include "report/page/labels.h"

namespace mcdem::inline report {
namespace {

constexpr double distortion = 1e-6;  ///< smaller deviatoric strains of a cell are ignored

/// What an axis shows.
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

std::vector<Track> tracks_of(const Cast& cast, bool cells) {
    std::vector<Track> tracks;
    for (const Series& series : cast.simulated)
        if (const auto& replicas = series.setting.replicas;
            follows_programme(replicas) && are_cells(replicas) == cells)
            tracks.push_back({&series, mean_scans(replicas)});
    return tracks;
}

RunFigure figure_of(const std::vector<Track>& tracks, const std::string& name, const std::string& title,
                    const Axis& x, const Axis& y) {
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
    return figure;
}

/// Largest value of a quantity in all scans.
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
    const auto add = [&](const char* name, const char* title, const Axis& x, const Axis& y) {
        figures.push_back(figure_of(tracks, name, title, x, y));
    };
    add("force_time", "Force on the plate against time", time_axis, force);
    add("displacement_time", "Displacement of the plate against time", time_axis, moved);
    add("force_displacement", "Force on the plate against displacement", moved, force);
}

void add_cells(const std::vector<Track>& tracks, std::vector<RunFigure>& figures) {
    const auto [p, q] = stresses_of(tracks);
    figures.push_back(figure_of(tracks, "pressure_strain", "Mean stress against volume strain", volume, p));
    if (are_distorted(tracks))
        figures.push_back(figure_of(tracks, "shear_stress_strain",
                                    "Deviatoric stress against deviatoric strain", shear, q));
    figures.push_back(figure_of(tracks, "cell_coordination", "Contacts per grain",
                                {"packing fraction φ", 1, &MeanScan::packing_fraction},
                                {"contacts per grain Z", 1, &MeanScan::coordination}));
}

/// For plates, and for cells that are distorted.
void add_stress_path(const std::vector<Track>& tracks, std::vector<RunFigure>& figures) {
    const auto [p, q] = stresses_of(tracks);
    figures.push_back(figure_of(tracks, "stress_path", "Stress path", p, q));
}

void add_times_of_cells(const std::vector<Track>& tracks, std::vector<RunFigure>& figures) {
    const auto holds = [](const Track& track) { return has_hold(track.series->setting.replicas); };
    if (std::ranges::none_of(tracks, holds)) return;
    const auto [p, q] = stresses_of(tracks);
    const auto add = [&](const char* name, const char* title, const Axis& y) {
        figures.push_back(figure_of(tracks, name, title, time_axis, y));
    };
    add("pressure_time", "Mean stress against time", p);
    add("volume_time", "Volume strain against time", volume);
    if (!are_distorted(tracks)) return;
    add("shear_stress_time", "Deviatoric stress against time", q);
    add("shear_strain_time", "Deviatoric strain against time", shear);
}

}  // namespace

std::vector<RunFigure> programme_figures(const Cast& cast) {
    std::vector<RunFigure> figures;
    const auto plates = tracks_of(cast, false), cells = tracks_of(cast, true);
    if (!plates.empty()) add_plates(plates, figures);
    if (!cells.empty()) add_cells(cells, figures);
    auto paths = plates;
    if (are_distorted(cells)) paths.insert(paths.end(), cells.begin(), cells.end());
    if (!paths.empty()) add_stress_path(paths, figures);
    add_times_of_cells(cells, figures);
    std::erase_if(figures, [](const RunFigure& figure) { return figure.series.empty(); });
    return figures;
}

}  // namespace mcdem::report
