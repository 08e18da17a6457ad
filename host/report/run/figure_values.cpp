#include "report/run/figure_values.h"

#include <cmath>

namespace mcdem::inline report {
namespace {

using Json = nlohmann::ordered_json;

constexpr int format = 1;  ///< of the file

Json curve_json(const FigureCurve& curve) {
    Json x = Json::array(), y = Json::array(), error = Json::array();
    for (const auto& point : curve.points)
        x.push_back(point.x), y.push_back(point.y), error.push_back(point.error);
    return {{"phase", name(curve.phase)}, {"x", x}, {"y", y}, {"standard_error", error}};
}

Json series_json(const FigureSeries& shown, bool is_reference) {
    const Series& series = *shown.series;
    Json json{{"setting", series.setting.label},
              {"words", series.words},
              {"remark", shown.remark},
              {"colour", series.style.colour},
              {"marker", series.style.marker},
              {"is_reference", is_reference},
              {"replicas", series.setting.replicas.size()}};
    if (std::isfinite(shown.slope)) json["slope"] = shown.slope;
    json["curves"] = Json::array();
    for (const auto& curve : shown.curves) json["curves"].push_back(curve_json(curve));
    return json;
}

}  // namespace

Json figure_values(const RunFigures& figures, const FigureData& data) {
    Json values = Json::object();
    for (const auto& figure : figures.figures) {
        Json& json = values[figure.name] = {{"x_label", figure.x_label}, {"y_label", figure.y_label}};
        if (figure.displacement) json["displacement_mm"] = *figure.displacement;
        json["series"] = Json::array();
        for (const auto& series : figure.series)
            json["series"].push_back(series_json(series, data.is_reference(*series.series)));
    }
    return values;
}

std::string figure_file(const Json& figures) {
    Json all{{"mcdem_figures", format}};
    all.update(figures);
    return all.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace mcdem::report
