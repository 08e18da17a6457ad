#include "challenge/results.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "challenge/evidence.h"
#include "core/errors.h"
#include "core/input_file.h"

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

}  // namespace

fs::path evidence_file(const fs::path& folder, const OpenCase& open_case) {
    return folder / "evidence" / (open_case.folder + ".json");
}

ChallengeResults read_challenge_results(const fs::path& folder, const OpenChallenge& challenge) {
    ChallengeResults results{read_library(folder / "library.json"), {}};
    for (const OpenCase& open_case : challenge.cases) results.cases.push_back(read_case(folder, open_case));
    return results;
}

}  // namespace mcdem::challenge
