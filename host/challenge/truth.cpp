#include "challenge/truth.h"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "core/input_file.h"
#include "core/sha256.h"

namespace mcdem::inline challenge {
namespace {

using Json = nlohmann::ordered_json;
constexpr int truth_format = 1;
constexpr std::string_view kinds[] = {"none", "effect", "pair", "unknown", "outside_prior"};

Json hidden_json(const std::vector<Hidden>& list) {
    Json json = Json::array();
    for (const Hidden& hidden : list)
        json.push_back({{"name", hidden.name}, {"amplitude", hidden.amplitude}});
    return json;
}

std::vector<Hidden> hidden_of(const Json& json) {
    std::vector<Hidden> list;
    for (const auto& entry : json) list.push_back({entry.at("name"), entry.at("amplitude")});
    return list;
}

CaseKind kind_of(const std::string& name) {
    for (std::size_t k = 0; k < std::size(kinds); ++k)
        if (kinds[k] == name) return static_cast<CaseKind>(k);
    throw InputError("there is no kind " + name);
}

ChallengeCase case_of(const Json& json) {
    return {json.at("folder"),
            kind_of(json.at("kind")),
            hidden_of(json.at("effects")),
            hidden_of(json.at("nuisances")),
            json.at("struck"),
            json.at("packing"),
            json.at("seed")};
}

}  // namespace

std::string_view case_kind_name(CaseKind kind) { return kinds[static_cast<std::size_t>(kind)]; }

std::string truth_text(const Challenge& challenge) {
    Json cases = Json::array();
    for (const ChallengeCase& c : challenge.cases)
        cases.push_back({{"folder", c.folder},
                         {"kind", case_kind_name(c.kind)},
                         {"effects", hidden_json(c.effects)},
                         {"nuisances", hidden_json(c.nuisances)},
                         {"struck", c.struck},
                         {"packing", c.packing},
                         {"seed", c.seed}});
    return Json{{"format", truth_format},
                {"seed", challenge.seed},
                {"scene_sha256", challenge.scene},
                {"packing_seeds", challenge.packing_seeds},
                {"cases", cases}}
               .dump(1) +
           "\n";
}

Challenge parse_truth(const std::string& text, const std::string& file_name) {
    try {
        const Json json = Json::parse(text);
        if (json.at("format") != truth_format) throw InputError(file_name + ": made by another version");
        Challenge challenge{json.at("seed"), json.at("scene_sha256"), json.at("packing_seeds"), {}};
        for (const auto& c : json.at("cases")) challenge.cases.push_back(case_of(c));
        return challenge;
    } catch (const Json::exception& error) {
        throw InputError(fmt::format("{}: not the truth of a challenge ({})", file_name, error.what()));
    }
}

std::string seal_of(const std::string& text) { return Sha256().add(text).hex(); }

Challenge open_truth(const std::filesystem::path& file, const std::string& seal) {
    const std::string text = read_file(file, "is missing; --truth says where the truth is");
    if (const std::string found = seal_of(text); found != seal)
        throw InputError(
            fmt::format("{}: is not the truth that was sealed: its SHA-256 is {}, challenge.json says {}",
                        file.string(), found, seal));
    return parse_truth(text, file.string());
}

}  // namespace mcdem::challenge
