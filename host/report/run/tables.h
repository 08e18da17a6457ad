// The tables that a run and a comparison end with.
#pragma once
#include "metrics/compare.h"
#include "metrics/model_table.h"
#include "metrics/scaling.h"
#include "report/page/text_table.h"

namespace mcdem::inline report {

/// "0.430 ± 0.012"; without its error where that is not known, a dash where there is no value.
std::string with_error(const Estimate& estimate, int decimals, double unit = 1);

/// "plate's speed: error of forces at most 0.5 %, estimated"; what to set where that is much, and, of
/// strokes, what measures it.
std::string rate_note(const std::string& what, double rate_error, bool strokes = true);

/// `from`: the displacement or scan from which on grains overlap more than the law was tested for.
std::string beyond_note(const std::string& setting, const std::string& from, const BeyondLaw& beyond);

/// In quotes where it has to be.
std::string csv_field(const std::string& text);

/// Scene keys that are not the same in all settings, seeds left out, and each setting's values of them.
struct VaryingKeys {
    std::vector<std::string> keys;
    std::vector<std::vector<std::string>> values;
};
VaryingKeys varying_keys(const std::vector<Setting>& settings);

/// Top force at full stroke, or at its last scan with a mark, and over the reference setting's.
TextTable table_of_models(const ModelTable& models);

/// The same as table_of_models for programs: a row a setting, with a column for each scene key that is not
/// the same in all.
std::string csv_of_models(const ModelTable& models, const std::vector<Setting>& settings);

/// The paper's Table I, one row a setting, with what was not available below.
TextTable table_of_comparisons(const std::vector<Comparison>& comparisons);

/// Coefficient, R^2 and curvature of the scaling law by setting and phase.
TextTable table_of_scaling(const std::vector<Setting>& settings, const LevelOptions& options = {});

}  // namespace mcdem::report
