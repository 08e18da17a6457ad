#include "report/run/scan_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/errors.h"
#include "metrics/law_range.h"
#include "metrics/model_table.h"
#include "report/page/labels.h"
#include "report/run/tables.h"

namespace mcdem::inline report {
namespace {

/// Scans of one setting.
struct Told {
    const Setting* setting;
    std::vector<MeanScan> scans;
};

std::vector<Told> told_of(const std::vector<Setting>& settings, bool cells) {
    std::vector<Told> told;
    for (const Setting& setting : settings)
        if (are_cells(setting.replicas) == cells) told.push_back({&setting, mean_scans(setting.replicas)});
    return told;
}

/// A column of means.
struct Quantity {
    std::string title, csv_name;
    std::function<const Estimate&(const MeanScan&)> of;
    double unit = 1;  ///< for tables; CSV uses SI units
    int decimals = 3;
};

double largest(const std::vector<Told>& told, const Quantity& quantity) {
    double most = 0;
    for (const Told& one : told)
        for (const MeanScan& scan : one.scans) most = std::fmax(most, std::fabs(quantity.of(scan).value));
    return most;
}

/// Number of decimals with which the largest number has four digits.
int four_digits(double largest) {
    return largest > 0 ? std::clamp(3 - static_cast<int>(std::floor(std::log10(largest))), 0, 6) : 1;
}

const char* const strain_names[]{"strain_x", "strain_y", "strain_z", "shear_xy", "shear_xz", "shear_yz"};

/// Nonzero strains, with one column for the first three if they are equal; or all six.
std::vector<Quantity> strains(const std::vector<Told>& told, bool all) {
    std::vector<Quantity> columns;
    const auto strain = [](std::size_t k) {
        return [k](const MeanScan& scan) -> const Estimate& { return scan.strain[k]; };
    };
    const bool isotropic = !all && std::ranges::all_of(told, [](const Told& one) {
        return std::ranges::all_of(one.scans, [](const MeanScan& scan) {
            return scan.strain[0].value == scan.strain[1].value &&
                   scan.strain[0].value == scan.strain[2].value;
        });
    });
    for (std::size_t k = isotropic ? 2 : 0; k < 6; ++k) {
        std::string words = isotropic && k == 2 ? "strain" : strain_names[k];
        std::ranges::replace(words, '_', ' ');
        Quantity column{words + " [%]", strain_names[k], strain(k), 1e-2, 2};
        if (all || largest(told, column) > 0) columns.push_back(std::move(column));
    }
    return columns;
}

std::vector<Quantity> plate_quantities() {
    return {{"displacement [mm]", "displacement_m", &MeanScan::displacement, 1e-3, 3},
            {"top force [N]", "top_force_N", &MeanScan::top_force, 1, 4},
            {"Z", "coordination_number", &MeanScan::coordination, 1, 2}};
}

std::vector<Quantity> cell_quantities(const std::vector<Told>& told, bool all_strains = false) {
    auto columns = strains(told, all_strains);
    columns.push_back({"φ", "packing_fraction", &MeanScan::packing_fraction, 1, 4});
    Quantity p{"p", "p_Pa", &MeanScan::p}, q{"q", "q_Pa", &MeanScan::q};
    const double most = std::fmax(largest(told, p), largest(told, q));
    const StressUnit unit = stress_unit(most);
    for (Quantity* stress : {&p, &q}) {
        stress->title += fmt::format(" [{}]", unit.name);
        stress->unit = unit.size;
        stress->decimals = four_digits(most / unit.size);
        columns.push_back(*stress);
    }
    columns.push_back({"Z", "coordination_number", &MeanScan::coordination, 1, 2});
    return columns;
}

/// The first scan in which a replica's overlaps exceed the tested range.
int first_beyond(const std::vector<MeanScan>& scans, double tested) {
    const auto beyond = [&](const MeanScan& scan) { return scan.max_overlap > tested; };
    return std::ranges::find_if(scans, beyond)->frame;
}

void add_notes(TextTable& table, const Told& one) {
    const auto words = words_for(one.setting->label);
    const auto& replicas = one.setting->replicas;
    if (const auto beyond = beyond_law(replicas))
        table.notes.push_back(
            beyond_note(words, fmt::format("scan {}", first_beyond(one.scans, beyond->tested)), *beyond));
    const Recording* first = nullptr;
    int failed = 0;
    for (const Recording* recording : replicas) {
        if (!recording->failure) continue;
        ++failed;
        if (!first || recording->scans.size() < first->scans.size()) first = recording;
    }
    if (first)
        table.notes.push_back(fmt::format("{}: {} of {} stopped early, the first after {} scans: {}", words,
                                          failed, replicas.size(), first->scans.size(),
                                          one_line(first->failure->cause)));
}

bool some_lack_scans(const std::vector<Told>& told) {
    return std::ranges::any_of(told, [](const Told& one) {
        return std::ranges::any_of(one.scans, [&](const MeanScan& scan) {
            return scan.time.count < static_cast<int>(one.setting->replicas.size());
        });
    });
}

TextTable table_of(const std::vector<Told>& told, bool cells) {
    TextTable table;
    const auto quantities = cells ? cell_quantities(told) : plate_quantities();
    table.columns = {{"model", Align::left}, {"scan"}, {"phase", Align::left}, {"time [s]"}};
    for (const Quantity& quantity : quantities) table.columns.push_back({quantity.title});
    const bool lacking = some_lack_scans(told);
    if (lacking) table.columns.push_back({"replicas"});
    double rate_error = not_available;
    for (const Told& one : told) {
        for (const MeanScan& scan : one.scans) {
            auto& row = table.rows.emplace_back();
            row = {words_for(one.setting->label), std::to_string(scan.frame), std::string(name(scan.phase)),
                   with_error({scan.time.value}, 3)};
            for (const auto& [title, _, of, unit, decimals] : quantities)
                row.push_back(with_error(of(scan), decimals, unit));
            if (lacking) row.push_back(std::to_string(scan.time.count));
        }
        add_notes(table, one);
        rate_error = std::fmax(rate_error, largest_rate_error(one.setting->replicas));
    }
    if (cells)
        table.notes.push_back(
            "p: mean stress, q: deviatoric stress, sqrt(3/2 s:s); strains over the lengths "
            "at start, compression positive");
    if (std::isfinite(rate_error))
        table.notes.push_back(rate_note(
            cells ? "rate of strain: error of stresses" : "plate's speed: error of forces", rate_error));
    return table;
}

std::string known(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

}  // namespace

std::vector<TextTable> tables_of_scans(const std::vector<Setting>& settings) {
    std::vector<TextTable> tables;
    for (const bool cells : {false, true})
        if (const auto told = told_of(settings, cells); !told.empty())
            tables.push_back(table_of(told, cells));
    return tables;
}

std::string csv_of_scans(const std::vector<Setting>& settings) {
    const auto plates = told_of(settings, false), cells = told_of(settings, true);
    if (!plates.empty() && !cells.empty())
        throw InputError("--csv: cells and plates have different columns; give the runs one by one");
    const auto& told = cells.empty() ? plates : cells;
    const auto quantities = cells.empty() ? plate_quantities() : cell_quantities(told, true);
    const auto [keys, values] = varying_keys(settings);
    std::string text = "setting,";
    for (const auto& key : keys) text += key + ",";
    text += "frame,cycle,phase,time_s";
    for (const Quantity& quantity : quantities)
        text += fmt::format(",{0},{0}_standard_error", quantity.csv_name);
    text += ",replicas\n";
    for (std::size_t s = 0; s < told.size(); ++s)
        for (const MeanScan& scan : told[s].scans) {
            text += csv_field(told[s].setting->label) + ",";
            for (const auto& value : values[s]) text += csv_field(value) + ",";
            text += fmt::format("{},{},{},{}", scan.frame, scan.cycle, name(scan.phase), scan.time.value);
            for (const Quantity& quantity : quantities)
                text += fmt::format(",{},{}", known(quantity.of(scan).value),
                                    known(quantity.of(scan).standard_error));
            text += fmt::format(",{}\n", scan.time.count);
        }
    return text;
}

}  // namespace mcdem::report
