#include "challenge/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "core/input_file.h"
#include "diagnose/infer/json_numbers.h"

namespace mcdem::inline diagnose {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CandidateRange, name, unit, low, high)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(NuisancePrior, name, unit, sigma)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Proposal, candidates, amplitudes, errors, gain, misfit_p, confirmed_gain,
                                   confirmed_misfit_p, left_out, rest_misfit_p, reduction,
                                   confirmed_reduction)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Findings, p_value, names, effects, gain, proposals, held_out,
                                   held_out_noise, placebo, numerics)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Evidence, seed, observed, baseline, candidates, nuisances)

}  // namespace mcdem::diagnose

namespace mcdem::inline challenge {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Reads the scored keys of diagnosis.json.
void read_diagnosis(const json& diagnosis, CaseResult& result) {
    for (const json& limit : diagnosis.at("detection_limits"))
        result.detection_limits[limit.at("effect")] =
            limit.at("minimum_amplitude").is_null() ? INFINITY : limit.at("minimum_amplitude").get<double>();
    const json& gap_reduction = diagnosis.at("shrink");
    if (gap_reduction.is_null() || gap_reduction.at("confirmed").is_null()) return;
    result.gap_reduction = {gap_reduction.at("fraction"), gap_reduction.at("interval"),
                            gap_reduction.at("confirmed")};
}

CaseResult read_case(const fs::path& folder, const OpenCase& open_case) {
    const fs::path file = folder / (open_case.folder + ".json");
    const std::string text = read_file(file, "is missing; `mcdem challenge run` must have ended");
    CaseResult result;
    try {
        const json diagnosis = json::parse(text);
        if (diagnosis.contains("problem")) {
            result.problem = diagnosis.at("problem");
            return result;
        }
        read_diagnosis(diagnosis, result);
    } catch (const json::exception& error) {
        throw InputError(fmt::format("{}: not a diagnosis of a challenge ({})", file.string(), error.what()));
    }
    result.findings = read_findings(folder / "findings" / (open_case.folder + ".json"));
    return result;
}

bool has(const std::vector<Signature>& list, const std::string& name) {
    return std::ranges::find(list, name, &Signature::name) != list.end();
}

Evidence evidence_of(const json& j, const Library& library) {
    Evidence evidence = j;
    evidence.library = library;
    evidence.library_is_own = false;  // a challenge has one library for all
    const auto cells = library.baseline.cols();
    expect_json(evidence.observed.size() == cells && evidence.baseline.cols() == cells,
                "it has other observables than the library", j);
    for (const CandidateRange& c : evidence.candidates)
        expect_json(has(library.effects, c.name), "the library lacks an effect of it", c);
    for (const NuisancePrior& n : evidence.nuisances)
        expect_json(has(library.nuisances, n.name), "the library lacks a nuisance of it", n);
    return evidence;
}

Findings findings_of(const json& j) {
    const Findings findings = j;
    expect_json(findings.names.size() == findings.gain.size(), "one gain per candidate is required", j);
    for (const Proposal& proposal : findings.proposals)
        for (const std::size_t candidate : proposal.candidates)
            expect_json(candidate < findings.names.size(), "it proposes a candidate that does not exist",
                        proposal);
    return findings;
}

json parsed(const std::filesystem::path& file) {
    return json::parse(read_file(file, "is missing; `mcdem challenge run` writes it"));
}

}  // namespace

fs::path evidence_file(const fs::path& folder, const OpenCase& open_case) {
    return folder / "evidence" / (open_case.folder + ".json");
}

ChallengeResults read_challenge_results(const fs::path& folder, const OpenChallenge& challenge) {
    ChallengeResults results{read_library(folder / "library.json"), {}};
    for (const OpenCase& open_case : challenge.cases) results.cases.push_back(read_case(folder, open_case));
    return results;
}

std::string evidence_text(const Evidence& evidence) { return json(evidence).dump(); }

Evidence read_evidence(const std::filesystem::path& file, const Library& library) try {
    return evidence_of(parsed(file), library);
} catch (const json::exception& error) {
    throw InputError(fmt::format("{}: not evidence of this challenge ({})", file.string(), error.what()));
}

std::string findings_text(const Findings& findings) { return json(findings).dump(); }

Findings read_findings(const std::filesystem::path& file) try {
    return findings_of(parsed(file));
} catch (const json::exception& error) {
    throw InputError(fmt::format("{}: not findings of a diagnosis ({})", file.string(), error.what()));
}

}  // namespace mcdem::challenge
