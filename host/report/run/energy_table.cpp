#include "report/run/energy_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "metrics/estimate.h"
#include "report/page/labels.h"

namespace mcdem::inline report {
namespace {

constexpr double mJ = 1e-3;

const std::pair<const char*, double Scan::*> columns[] = {{"work of walls", &Scan::wall_work},
                                                          {"of weight", &Scan::weight_work},
                                                          {"elastic", &Scan::elastic_energy},
                                                          {"kinetic", &Scan::kinetic_energy},
                                                          {"lost by damping", &Scan::damping_loss},
                                                          {"by friction", &Scan::friction_loss},
                                                          {"by drag", &Scan::drag_loss},
                                                          {"error", &Scan::energy_error}};

const Scan* most_loaded(const Recording& recording) {
    const auto less = [](const Scan& a, const Scan& b) { return a.elastic_energy < b.elastic_energy; };
    const auto scan = std::ranges::max_element(recording.scans, less);
    return scan == recording.scans.end() || std::isnan(scan->energy_error) ? nullptr : &*scan;
}

}  // namespace

TextTable table_of_energies(const std::vector<Setting>& settings) {
    TextTable table;
    table.columns = {{"model", Align::left}};
    for (const auto& [title, member] : columns) table.columns.push_back({std::string(title) + " [mJ]"});
    for (const Setting& setting : settings) {
        std::vector<const Scan*> scans;
        for (const Recording* recording : setting.replicas)
            if (const Scan* scan = most_loaded(*recording)) scans.push_back(scan);
        if (scans.empty()) continue;
        std::vector<std::string> row{words_for(setting.label)};
        for (const auto& [title, member] : columns) {
            std::vector<double> values;
            for (const Scan* scan : scans) values.push_back(scan->*member);
            row.push_back(fmt::format("{:.3g}", mean_over_replicas(values).value / mJ));
        }
        table.rows.push_back(std::move(row));
    }
    table.notes = {
        "at the scan with the largest elastic energy, since the first steps. Error: elastic and kinetic "
        "energy plus "
        "losses minus work; if positive, created by the time step or by an elastic energy that is an "
        "approximation "
        "(mc_dem, elastic_half_space); if negative, lost by viscoelasticity or plasticity"};
    return table;
}

}  // namespace mcdem::report
