#include "report/run/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/csv_text.h"
#include "core/errors.h"
#include "core/parameters.h"
#include "metrics/law_range.h"
#include "metrics/programmes.h"
#include "report/page/labels.h"

namespace mcdem::inline report {
namespace {

std::string number(double value, int decimals) {
    return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : no_number;
}

/// Notes for each setting; common notes once.
std::vector<std::string> notes_of(const std::vector<Comparison>& comparisons) {
    std::vector<std::string> notes;
    for (const auto& c : comparisons)
        for (const auto& note : c.notes) {
            const bool shared = std::ranges::all_of(comparisons, [&](const Comparison& other) {
                return std::ranges::find(other.notes, note) != other.notes.end();
            });
            if (!shared)
                notes.push_back(words_for(c.setting) + ": " + note);
            else if (&c == &comparisons.front())
                notes.push_back(note);
        }
    return notes;
}

std::string per_cent(double error) {
    return (error < 0.995 ? fmt::format("{:.2g}", 100 * error) : three_digits(100 * error)) + " %";
}

/// If it is large, also which key to set and how to measure it. Single scans were measured for plates only.
std::string rate_note(bool cell, double rate_error) {
    constexpr double too_much = 0.02;
    std::string note = fmt::format("error of {}: at most {} in the mean over packings",
                                   cell ? "stresses by the strain rate" : "forces by the plate's speed",
                                   per_cent(rate_error));
    if (!cell) note += fmt::format(", {} in 95 % of single scans", per_cent(rate_error + course_error));
    note += " (estimate)";
    if (rate_error > too_much)
        note += "; set protocol.rate_tolerance to reduce it; `mcdem converge` measures it";
    return note;
}

/// `from`: the displacement or scan from which on overlaps exceed the tested range.
std::string beyond_note(const std::string& setting, const std::string& from, const BeyondLaw& beyond) {
    return fmt::format(
        "{}: from {} on, overlaps exceed the tested range of the contact model ({:.2f} of the sum of two "
        "radii) and reach {:.2f}; numerics.stop_beyond_law = true stops the run there",
        setting, from, beyond.tested, beyond.max_overlap);
}

/// Quotes the text if necessary.
std::string csv_field(const std::string& text) {
    const auto line = without_formula(one_line(text));
    return line.find_first_of(",\"") == std::string::npos ? line : csv_cell(line);
}

std::string begin_row(const std::string& setting, const std::vector<std::string>& cells) {
    std::string text = csv_field(setting) + ",";
    for (const auto& cell : cells) text += csv_field(cell) + ",";
    return text;
}

/// Scene keys that differ between settings, without seeds, and their values for each setting.
struct VaryingKeys {
    std::vector<std::string> keys;
    std::vector<std::vector<std::string>> values;
};
VaryingKeys varying_keys(const std::vector<Setting>& settings) {
    std::vector<Parameters> parameters;
    for (const auto& setting : settings) {
        parameters.push_back(setting.replicas.front()->parameters);
        parameters.back().erase("packing.seed");
    }
    VaryingKeys varying{keys_that_vary(parameters), {}};
    for (const auto& of_setting : parameters) {
        auto& values = varying.values.emplace_back();
        for (const auto& key : varying.keys) values.push_back(without_quotes(value_of(of_setting, key)));
    }
    return varying;
}

std::string known(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

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
    if (std::isfinite(rate_error)) table.notes.push_back(rate_note(cells, rate_error));
    return table;
}

}  // namespace

std::string with_error(const Estimate& estimate, int decimals, double unit) {
    if (!estimate.available()) return no_number;
    const bool has_error = std::isfinite(estimate.standard_error);
    const double value = estimate.value / unit, error = estimate.standard_error / unit;
    const double size = std::max(std::abs(value), has_error ? error : 0);
    if (size < 1e-4 && size > 0)
        return fmt::format("{:.2e}", value) + (has_error ? fmt::format(" ± {:.1e}", error) : "");
    if (size > 0) decimals = std::max(decimals, 1 - static_cast<int>(std::floor(std::log10(size))));
    return number(value, decimals) + (has_error ? " ± " + number(error, decimals) : "");
}

TextTable table_of_models(const ModelTable& models) {
    TextTable table;
    const auto full_stroke = std::isfinite(models.displacement)
                                 ? fmt::format("top force at {} mm [N]", number(models.displacement * 1e3, 2))
                                 : std::string("top force [N]");
    table.columns = {
        {"model", Align::left}, {full_stroke}, {"over " + words_for(models.reference)}, {"replicas"}};
    const bool some_failed =
        std::ranges::any_of(models.rows, [](const ModelRow& row) { return row.failed > 0; });
    if (some_failed) table.columns.push_back({"stopped early"});
    for (const auto& row : models.rows) {
        const auto mark = row.reached ? fmt::format(" * at {:.2f} mm", *row.reached * 1e3) : "";
        table.rows.push_back({words_for(row.setting), with_error(row.top_force, 2) + mark,
                              with_error(row.ratio, 3), std::to_string(row.replicas)});
        if (some_failed) table.rows.back().push_back(std::to_string(row.failed));
    }
    if (std::ranges::any_of(models.rows, [](const ModelRow& row) { return row.reached.has_value(); }))
        table.notes.push_back("*: no replica reached full stroke; force and ratio are of the last scan");
    for (const auto& row : models.rows)
        if (row.beyond)
            table.notes.push_back(beyond_note(
                words_for(row.setting), number(row.beyond->displacement * 1e3, 2) + " mm", *row.beyond));
    if (std::isfinite(models.rate_error)) table.notes.push_back(rate_note(false, models.rate_error));
    return table;
}

std::string csv_of_models(const ModelTable& models, const std::vector<Setting>& settings) {
    const auto [keys, values] = varying_keys(settings);
    std::string text = begin_row("setting", keys);
    text +=
        "displacement_mm,top_force_N,standard_error_N,over,ratio,ratio_standard_error,replicas,stopped_"
        "early\n";
    for (std::size_t r = 0; r < models.rows.size(); ++r) {
        const ModelRow& row = models.rows[r];
        text += begin_row(row.setting, values[r]);
        text += fmt::format(
            "{},{},{},{},{},{},{},{}\n", known(row.reached.value_or(models.displacement) * 1e3),
            known(row.top_force.value), known(row.top_force.standard_error), csv_field(models.reference),
            known(row.ratio.value), known(row.ratio.standard_error), row.replicas, row.failed);
    }
    return text;
}

TextTable table_of_comparisons(const std::vector<Comparison>& comparisons) {
    TextTable table;
    table.columns = {{"model", Align::left}, {"Rtop"},     {"errf [N]"}, {"errZ"},
                     {"bhat x 100"},         {"tau [mN]"}, {"levels"}};
    for (const auto& c : comparisons) {
        table.rows.push_back({words_for(c.setting), with_error(c.Rtop, 3), with_error(c.errf, 2),
                              with_error(c.errZ, 2), with_error(c.bhat, 2, 1e-2), with_error(c.tau, 2, 1e-3),
                              fmt::format("{} of {}", c.levels_errf, c.reference_levels)});
    }
    table.notes = notes_of(comparisons);
    table.notes.push_back(
        "levels: displacements used for errf, in loading and unloading, of those of the reference");
    table.rows.push_back({"perfect fit", "1", "0", "0", "0", "", ""});
    return table;
}

TextTable table_of_scaling(const std::vector<Setting>& settings) {
    TextTable table;
    table.columns = {{"model", Align::left},
                     {"phase", Align::left},
                     {"F / (Z phi b f) [1/m]"},
                     {"R^2"},
                     {"curvature"},
                     {"levels"}};
    for (const auto& setting : settings) {
        const auto points = scaling_points(group_levels(setting.replicas));
        for (Phase phase : {Phase::load, Phase::unload}) {
            const auto fit = fit_scaling(points, phase);
            table.rows.push_back({words_for(setting.label), std::string(name(phase)),
                                  number(fit.coefficient, 1), number(fit.r_squared, 4),
                                  number(fit.curvature, 3), std::to_string(fit.points)});
        }
    }
    table.notes = {
        "F: top force, Z: coordination number, phi: packing fraction, b: branch length, f: mean contact "
        "force",
        "curvature: part of F that is quadratic, at the largest Z phi b f; levels: number of displacements "
        "fitted"};
    return table;
}

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
    std::string text = begin_row("setting", keys);
    text += "frame,cycle,phase,time_s";
    for (const Quantity& quantity : quantities)
        text += fmt::format(",{0},{0}_standard_error", quantity.csv_name);
    text += ",replicas\n";
    for (std::size_t s = 0; s < told.size(); ++s)
        for (const MeanScan& scan : told[s].scans) {
            text += begin_row(told[s].setting->label, values[s]);
            text += fmt::format("{},{},{},{}", scan.frame, scan.cycle, name(scan.phase), scan.time.value);
            for (const Quantity& quantity : quantities)
                text += fmt::format(",{},{}", known(quantity.of(scan).value),
                                    known(quantity.of(scan).standard_error));
            text += fmt::format(",{}\n", scan.time.count);
        }
    return text;
}

}  // namespace mcdem::report
