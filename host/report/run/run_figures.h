// The paper's four figures made ready for drawing, in the units of their axes: top force, force distribution
// at one level, Z after thresholding, scaling law; those of programmes: programme_figures.h. Pages and
// figures for print show the same values.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "metrics/compare.h"
#include "metrics/force_distribution.h"
#include "report/page/series_style.h"

namespace mcdem::inline report {

struct FigureOptions {
    CompareOptions compare;
    std::vector<Comparison> comparisons =
        {};  ///< of the settings with the reference, where at hand; else made
    Phase distribution_phase =
        Phase::unload;  ///< the force distribution is shown while loading or unloading ..
    double distribution_displacement = 18e-3;  ///< .. at the level nearest to this [m]
    double threshold = 0;                      ///< of Z where no reference tells tau [N]
};

/// One setting, or the reference.
struct Series {
    std::string words;  ///< its name in the key
    SeriesStyle style;
    Setting setting;
    Levels levels;
    std::optional<Comparison> comparison;  ///< with the reference
};

/// All that is shown.
struct Cast {
    std::vector<Series> simulated;
    std::optional<Series> reference;
    bool is_reference(const Series& series) const { return reference && &series == &*reference; }
};

/// The settings that have scans left after their discarded cycles.
Cast cast_of(const std::vector<Setting>& settings, const std::optional<Setting>& reference,
             const FigureOptions& options);

/// A point with the standard error of its y over replicas, not-a-number where that is not known.
struct FigurePoint {
    double x = 0, y = 0, error = not_available;
};

struct FigureCurve {
    Phase phase;
    std::vector<FigurePoint> points;
};

/// What a figure shows of one series.
struct FigureSeries {
    const Series* series;             ///< of the cast
    std::string remark;               ///< behind its words in the key: "tau 4.00 mN"; may be empty
    std::vector<FigureCurve> curves;  ///< loading, unloading; without those that have no points
    double slope = not_available;     ///< of the line through zero fitted to all points, in the axes' units
};

struct RunFigure {
    std::string name;              ///< of its file: top_force
    std::string x_label, y_label;  ///< with units
    std::vector<FigureSeries> series;
    /// Of the force distribution: its level [mm].
    std::optional<double> displacement;
    std::string title = "";  ///< of a programme's, on a page
};

struct RunFigures {
    std::vector<RunFigure> figures;
    std::vector<std::string> missing;  ///< "the force distribution: no contacts recorded"
};

/// Views of the cast, which must live as long.
RunFigures run_figures(const Cast& cast, const FigureOptions& options);

/// Whether Z leaves out weak forces.
bool is_thresholded(const Cast& cast, const FigureOptions& options);

/// p(f) of one series at the level nearest to the one asked for.
struct ShownDensity {
    const Series* series;
    const Level* level;
    ForceDensity density;
};
/// On bins common to all, to the force that all but a few contacts stay below; empty where nothing is known.
std::vector<ShownDensity> shown_densities(const Cast& cast, const FigureOptions& options);

}  // namespace mcdem::report
