#include "challenge/evidence.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/errors.h"
#include "core/input_file.h"
#include "diagnose/infer/json_numbers.h"

namespace mcdem::inline challenge {
namespace {

using nlohmann::json;

void expect(bool right, const std::string& what, const json& where) {
    if (!right) throw json::other_error::create(501, what, &where);
}

bool has(const std::vector<Signature>& list, const std::string& name) {
    return std::ranges::find(list, name, &Signature::name) != list.end();
}

Evidence evidence_of(const json& j, const Library& library) {
    Evidence evidence;
    evidence.library = library;
    evidence.library_is_own = false;  // a challenge has one library for all
    evidence.seed = j.at("seed");
    evidence.observed = numbers_of(j.at("observed"));
    const auto cells = library.baseline.cols();
    expect(evidence.observed.size() == cells, "it has other observables than the library", j);
    const json& rows = j.at("baseline");
    evidence.baseline.resize(static_cast<Eigen::Index>(rows.size()), cells);
    for (std::size_t r = 0; r < rows.size(); ++r) {
        expect(static_cast<Eigen::Index>(rows[r].size()) == cells, "its rows are of unequal length", j);
        evidence.baseline.row(static_cast<Eigen::Index>(r)) = numbers_of(rows[r]);
    }
    for (const json& c : j.at("candidates")) {
        evidence.candidates.push_back({c.at("name"), c.at("unit"), c.at("low"), c.at("high")});
        expect(has(library.effects, evidence.candidates.back().name), "the library lacks an effect of it", c);
    }
    for (const json& n : j.at("nuisances")) {
        evidence.nuisances.push_back({n.at("name"), n.at("unit"), n.at("sigma")});
        expect(has(library.nuisances, evidence.nuisances.back().name), "the library lacks a nuisance of it",
               n);
    }
    return evidence;
}

json optional_json(const std::optional<double>& value) { return value ? json(*value) : json(); }

std::optional<double> optional_of(const json& value) {
    return value.is_null() ? std::nullopt : std::optional(value.get<double>());
}

Findings findings_of(const json& j) {
    Findings findings{j.at("p_value"),  j.at("names"),   j.at("effects"), j.at("gain"), {},
                      j.at("held_out"), j.at("placebo"), j.at("numerics")};
    expect(findings.names.size() == findings.gain.size(), "it has not one gain a candidate", j);
    for (const json& p : j.at("proposals")) {
        Proposal proposal{p.at("candidates"),
                          p.at("amplitudes"),
                          p.at("errors"),
                          p.at("gain"),
                          p.at("misfit_p"),
                          optional_of(p.at("confirmed_gain")),
                          optional_of(p.at("confirmed_misfit_p")),
                          p.at("reduction"),
                          optional_of(p.at("confirmed_reduction"))};
        for (const std::size_t candidate : proposal.candidates)
            expect(candidate < findings.names.size(), "it proposes a candidate that there is not", p);
        findings.proposals.push_back(proposal);
    }
    return findings;
}

json parsed(const std::filesystem::path& file) {
    return json::parse(read_file(file, "is missing; `mcdem challenge run` writes it"));
}

}  // namespace

std::string evidence_text(const Evidence& evidence) {
    json baseline = json::array(), candidates = json::array(), nuisances = json::array();
    for (Eigen::Index r = 0; r < evidence.baseline.rows(); ++r)
        baseline.push_back(numbers_json(evidence.baseline.row(r)));
    for (const CandidateRange& c : evidence.candidates)
        candidates.push_back({{"name", c.name}, {"unit", c.unit}, {"low", c.low}, {"high", c.high}});
    for (const NuisancePrior& n : evidence.nuisances)
        nuisances.push_back({{"name", n.name}, {"unit", n.unit}, {"sigma", n.sigma}});
    return json{{"seed", evidence.seed},
                {"observed", numbers_json(evidence.observed)},
                {"baseline", baseline},
                {"candidates", candidates},
                {"nuisances", nuisances}}
        .dump();
}

Evidence read_evidence(const std::filesystem::path& file, const Library& library) try {
    return evidence_of(parsed(file), library);
} catch (const json::exception& error) {
    throw InputError(fmt::format("{}: not evidence of this challenge ({})", file.string(), error.what()));
}

std::string findings_text(const Findings& findings) {
    json proposals = json::array();
    for (const Proposal& p : findings.proposals)
        proposals.push_back({{"candidates", p.candidates},
                             {"amplitudes", p.amplitudes},
                             {"errors", p.errors},
                             {"gain", p.gain},
                             {"misfit_p", p.misfit_p},
                             {"confirmed_gain", optional_json(p.confirmed_gain)},
                             {"confirmed_misfit_p", optional_json(p.confirmed_misfit_p)},
                             {"reduction", p.reduction},
                             {"confirmed_reduction", optional_json(p.confirmed_reduction)}});
    return json{{"p_value", findings.p_value}, {"names", findings.names},
                {"effects", findings.effects}, {"gain", findings.gain},
                {"proposals", proposals},      {"held_out", findings.held_out},
                {"placebo", findings.placebo}, {"numerics", findings.numerics}}
        .dump();
}

Findings read_findings(const std::filesystem::path& file) try {
    return findings_of(parsed(file));
} catch (const json::exception& error) {
    throw InputError(fmt::format("{}: not findings of a diagnosis ({})", file.string(), error.what()));
}

}  // namespace mcdem::challenge
