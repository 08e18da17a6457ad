// Tables of runs and comparisons.
#pragma once
#include "metrics/compare.h"
#include "metrics/model_table.h"
#include "metrics/scaling.h"
#include "report/page/text_table.h"

namespace mcdem::inline report {

/// "0.430 ± 0.012"; without the error if it is unknown, a dash without a value. More decimals if fewer than
/// two significant digits would be left, of the value or of a larger error.
std::string with_error(const Estimate& estimate, int decimals, double unit = 1);

/// "plate's speed: error of forces at most 0.5 %, estimated"; if it is large, also which key to set and, for
/// strokes, how to measure it.
std::string rate_note(const std::string& what, double rate_error, bool strokes = true);

/// `from`: the displacement or scan from which on overlaps exceed the tested range.
std::string beyond_note(const std::string& setting, const std::string& from, const BeyondLaw& beyond);

/// Quotes the text if necessary.
std::string csv_field(const std::string& text);

/// Scene keys that differ between settings, without seeds, and their values for each setting.
struct VaryingKeys {
    std::vector<std::string> keys;
    std::vector<std::vector<std::string>> values;
};
VaryingKeys varying_keys(const std::vector<Setting>& settings);

/// Top force at full stroke (or at the last scan, marked) and its ratio to the reference setting.
TextTable table_of_models(const ModelTable& models);

/// table_of_models as CSV: one row per setting, with a column for each scene key that varies.
std::string csv_of_models(const ModelTable& models, const std::vector<Setting>& settings);

/// Table I of the paper, one row per setting, with notes on unavailable data.
TextTable table_of_comparisons(const std::vector<Comparison>& comparisons);

/// Coefficient, R^2 and curvature of the scaling law by setting and phase.
TextTable table_of_scaling(const std::vector<Setting>& settings, const LevelOptions& options = {});

}  // namespace mcdem::report
