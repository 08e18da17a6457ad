#include "diagnose/decide/diagnosis_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/errors.h"

namespace mcdem::inline diagnose {
namespace {

constexpr double mm = 1e-3;

using Json = nlohmann::ordered_json;

/// An object whose members are read or written by the same list (`describe`). null represents NaN, infinity
/// (written so by the library) and unknown values.
class Members {
public:
    Members(Json& json, bool reads) : json_(json), reads_(reads) {}

    void operator()(const char* key, auto& value) { exchange(place(key), value); }
    /// A member that files of earlier versions do not have.
    void later(const char* key, auto& value) {
        if (!reads_ || json_.contains(key)) (*this)(key, value);
    }
    /// A member that follows from others and is only written.
    void derived(const char* key, const auto& value) {
        if (!reads_) json_[key] = value;
    }
    void text_or_null(const char* key, std::string& text) {
        std::optional<std::string> known = text.empty() ? std::nullopt : std::optional(text);
        (*this)(key, known);
        text = known.value_or("");
    }
    void number_or(const char* key, double& number, double of_null) {
        (*this)(key, number);
        if (std::isnan(number)) number = of_null;
    }
    /// Rounded to a nanometre, to remove noise in the last digits.
    void millimetres(const char* key, double& metres) {
        double length = std::round(metres * 1e9) / 1e6;
        (*this)(key, length);
        if (reads_) metres = length * mm;
    }
    void millimetres(const char* key, std::array<double, 2>& metres) {
        std::array<double, 2> lengths{std::round(metres[0] * 1e9) / 1e6, std::round(metres[1] * 1e9) / 1e6};
        (*this)(key, lengths);
        if (reads_) metres = {lengths[0] * mm, lengths[1] * mm};
    }
    /// Pairs as an object, in this order.
    void object(const char* key, std::vector<std::pair<std::string, std::array<double, 2>>>& pairs) {
        Json& json = place(key);
        if (!reads_) json = Json::object();
        if (reads_)
            for (const auto& [name, _] : json.items()) pairs.emplace_back(name, std::array<double, 2>{});
        for (auto& [name, values] : pairs) exchange(json[name], values);
    }

private:
    Json& place(const char* key) { return reads_ ? json_.at(key) : json_[key]; }

    template <class Value>
    void exchange(Json& json, Value& value) {
        if constexpr (requires(Members members) { describe(members, value); }) {
            if (!reads_) json = Json::object();
            Members members(json, reads_);
            describe(members, value);
        } else if (reads_) {
            json.get_to(value);
        } else {
            json = value;
        }
    }
    void exchange(Json& json, double& number) {
        if (reads_)
            number = json.is_null() ? std::nan("") : json.get<double>();
        else
            json = number;
    }
    template <class Value>
    void exchange(Json& json, std::optional<Value>& value) {
        if (reads_ && json.is_null()) return value.reset();
        if (reads_) value.emplace();
        if (value) exchange(json, *value);
    }
    template <class Value>
    void exchange(Json& json, std::vector<Value>& values) {
        if (!reads_) json = Json::array();
        if (reads_)
            for (auto& item : json) exchange(item, values.emplace_back());
        else
            for (auto& value : values) exchange(json.emplace_back(), value);
    }
    void exchange(Json& json, std::array<double, 2>& numbers) {
        for (std::size_t k = 0; k < 2; ++k) exchange(reads_ ? json.at(k) : json.emplace_back(), numbers[k]);
    }

    Json& json_;
    bool reads_;
};

constexpr double infinite = std::numeric_limits<double>::infinity();

void describe(Members& io, WhereEntry& entry) {
    io("observable", entry.observable);
    io.text_or_null("phase", entry.phase);
    io.millimetres("displacement_mm", entry.displacement);
    io("region", entry.region);
    io("z_score", entry.z_score);
    io("z_score_refitted", entry.z_score_refitted);
    io("force_class", entry.force_class);
    io.later("difference", entry.difference);
}

void describe(Members& io, WhereCell& cell) {
    io("observable", cell.observable);
    io.text_or_null("phase", cell.phase);
    io.millimetres("displacement_mm", cell.displacement);
    io("z_score", cell.z_score);
    io("z_score_refitted", cell.z_score_refitted);
    io.later("difference", cell.difference);
}

void describe(Members& io, Cause& cause) {
    io("effect", cause.effect);
    io("amplitude", cause.amplitude);
    io("unit", cause.unit);
    io("confidence", cause.confidence);
    io("group", cause.group);
    io.number_or("amplitude_error", cause.amplitude_error, infinite);
    io("at_limit", cause.at_limit);
    io("explained", cause.explained);
    io("score", cause.score);
    io("confirmed_score", cause.confirmed_score);
}

/// A row of GapReduction::top_force.
void describe(Members& io, std::array<double, 4>& row) {
    io.millimetres("displacement_mm", row[0]);
    io("experiment_N", row[1]);
    io("before_N", row[2]);
    io("after_N", row[3]);
}

void describe(Members& io, GapReduction& gap) {
    io("held_out", gap.held_out);
    io("before", gap.before);
    io("after", gap.after);
    io("fraction", gap.fraction);
    io("interval", gap.interval);
    io("placebo", gap.placebo);
    io.object("metrics", gap.metrics);
    io("confirmed", gap.confirmed);
    io.millimetres("fitted_displacement_mm", gap.fitted_displacement);
    io("top_force", gap.top_force);
}

void describe(Members& io, Explanation& explanation) {
    io("reduction", explanation.reduction);
    io("simulated", explanation.simulated);
    io("held_out", explanation.held_out);
    io("placebo", explanation.placebo);
    io("needed", explanation.needed);
    io.derived("remainder", explanation.remainder());
    io("remainder_p", explanation.remainder_p);
    io("leaves_more_than_noise", explanation.leaves_more_than_noise);
    io("without", explanation.without);
}

void describe(Members& io, PackingAgreement& packing) {
    io("experiment", packing.experiment);
    io("gap_p", packing.gap_p);
    io("amplitude", packing.amplitude);
    io.number_or("amplitude_error", packing.amplitude_error, infinite);
    io("agreement_p", packing.agreement_p);
    io("differs", packing.differs);
}

void describe(Members& io, Refinement& refinement) {
    io("effect", refinement.effect);
    io("key", refinement.key);
    io("was", refinement.from);
    io("to", refinement.to);
    io("unit", refinement.unit);
    io("done", refinement.done);
}

void describe(Members& io, NextStep& step) {
    io("what", step.what);
    io("power", step.power);
}

void describe(Members& io, DetectionLimit& limit) {
    io("effect", limit.effect);
    io.number_or("minimum_amplitude", limit.minimum_amplitude, infinite);
    io("absorbed_by_calibration", limit.absorbed_by_calibration);
    io("unit", limit.unit);
    io("group", limit.group);
}

void describe(Members& io, NuisanceFit& fit) {
    io("name", fit.name);
    io("shift", fit.value);
    io("error", fit.error);
    io("prior", fit.prior);
    io("unit", fit.unit);
    io("at_bound", fit.at_bound);
}

void describe(Members& io, MissingBins& missing) {
    io("of", missing.of);
    io("bins", missing.count);
    io("of_bins", missing.all);
    io.derived("share", missing.share());
    io("for_all", missing.for_all);
}

/// Members that are in an object of their own.
struct Gap {
    Diagnosis& of;
};
void describe(Members& io, Gap& gap) {
    io("detected", gap.of.detected);
    io("p_value", gap.of.p_value);
    io("p_omnibus", gap.of.p_omnibus);
    io("p_directed", gap.of.p_directed);
}

/// In the order of Verdict.
constexpr std::array verdict_names{"no_gap",         "effect",        "group",
                                   "unknown_effect", "not_converged", "calibration_suspect"};

Verdict verdict_of(const std::string& word) {
    const auto found = std::ranges::find(verdict_names, word);
    if (found == verdict_names.end()) throw std::invalid_argument("unknown verdict: " + word);
    return static_cast<Verdict>(found - verdict_names.begin());
}

void describe(Members& io, Diagnosis& diagnosis) {
    std::string verdict = verdict_name(diagnosis.verdict);
    io("verdict", verdict);
    diagnosis.verdict = verdict_of(verdict);
    Gap gap{diagnosis};
    io("gap", gap);
    io("where", diagnosis.where);
    io("causes", diagnosis.causes);
    io.later("explanation", diagnosis.explanation);
    io("shrink", diagnosis.gap_reduction);
    io("detection_limits", diagnosis.detection_limits);
    io("not_measured", diagnosis.not_measured);
    io("seconds", diagnosis.seconds);
    io.number_or("where_threshold", diagnosis.where_threshold, 0);
    io("cells", diagnosis.cells);
    io("ranking", diagnosis.ranking);
    io("nuisances", diagnosis.nuisances);
    io.later("check_first", diagnosis.check_first);
    io.later("missing_bins", diagnosis.missing_bins);
    io("not_testable", diagnosis.not_testable);
    io.later("refinements", diagnosis.refinements);
    io.later("next", diagnosis.next);
    io.later("packings", diagnosis.packings);
    io("provenance", diagnosis.provenance);
}

}  // namespace

std::string verdict_name(Verdict verdict) { return verdict_names[static_cast<std::size_t>(verdict)]; }

std::string diagnosis_json(const Diagnosis& diagnosis) {
    Json json = Json::object();
    Members members(json, false);
    Diagnosis written = diagnosis;
    describe(members, written);
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Diagnosis diagnosis_of_json(const std::string& text, const std::string& where) {
    try {
        Json json = Json::parse(text);
        Members members(json, true);
        Diagnosis diagnosis;
        describe(members, diagnosis);
        return diagnosis;
    } catch (const std::exception& error) {
        throw InputError(where + ": must be a diagnosis.json that `mcdem diagnose` wrote; " + error.what());
    }
}

}  // namespace mcdem::diagnose
