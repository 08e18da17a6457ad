// Values of the four figures of the paper in the units of their axes: top force, force distribution at one
// level, Z after thresholding, scaling law; and of the figures of programmes. Pages and figures for print
// show the same values.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "metrics/compare.h"
#include "metrics/force_distribution.h"
#include "report/page/labels.h"

namespace mcdem::inline report {

struct FigureOptions {
    std::optional<double> touch_force = {};  ///< of compare()
    std::vector<Comparison> comparisons =
        {};  ///< comparisons of the settings with the reference, if available; otherwise computed
    double distribution_displacement = 18e-3;  ///< of the force distribution: the level nearest to this [m]
    double threshold = 0;                      ///< for Z, if no reference determines tau [N]
};

/// One setting, or the reference.
struct Series {
    std::string words;  ///< its name in the legend
    SeriesStyle style;
    Setting setting;
    Levels levels;
    std::optional<Comparison> comparison;  ///< with the reference
};

/// The data of all figures of runs.
struct FigureData {
    std::vector<Series> simulated;
    std::optional<Series> reference;
    bool is_reference(const Series& series) const { return reference && &series == &*reference; }
};

/// The settings that have scans after their discarded cycles.
FigureData figure_data(const std::vector<Setting>& settings, const std::optional<Setting>& reference,
                       const FigureOptions& options);

/// A point with the standard error of its y over replicas, NaN if unknown.
struct FigurePoint {
    double x = 0, y = 0, error = not_available;
};

struct FigureCurve {
    Phase phase;
    std::vector<FigurePoint> points;
};

struct FigureSeries {
    const Series* series;             ///< in the data
    std::string remark;               ///< appended to the name in the legend: "tau 4.00 mN"; may be empty
    std::vector<FigureCurve> curves;  ///< loading, unloading; only curves with points
    double slope =
        not_available;  ///< of the line through the origin fitted to all points, in the units of the axes
};

struct RunFigure {
    std::string name;              ///< name of its file: top_force
    std::string x_label, y_label;  ///< with units
    std::vector<FigureSeries> series;
    /// Level of the force distribution [mm].
    std::optional<double> displacement;
    std::string title = "";  ///< for programmes, on a page
};

struct RunFigures {
    std::vector<RunFigure> figures;
    std::vector<std::string> missing;  ///< "the force distribution: no contacts were recorded"
};

/// Holds pointers to the data, which must outlive it.
RunFigures run_figures(const FigureData& data, const FigureOptions& options);

/// Whether Z ignores weak forces.
bool is_thresholded(const FigureData& data, const FigureOptions& options);

/// Figures of programmes that have data, scan by scan: force and displacement of a plate, stress and strain
/// of a cell, against one another and against time. Time is shown for plates, and for cells with a hold;
/// figures of distortion only for cells that are distorted.
std::vector<RunFigure> programme_figures(const FigureData& data);

}  // namespace mcdem::report
