#include "challenge/files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <set>

#include "core/errors.h"
#include "core/input_file.h"

namespace mcdem::inline challenge {
namespace {

using Json = nlohmann::ordered_json;
constexpr int challenge_format = 1;

/// Names of cases are also names of files of results: only plain names that do not collide with other files.
bool is_name_of_a_case(const std::string& name) {
    return name.starts_with("case_") && name.size() <= 100 &&
           std::ranges::all_of(name, [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
}

void expect_names(const OpenChallenge& challenge, const std::filesystem::path& file) {
    std::set<std::string> seen;
    std::vector<std::string> problems;
    for (const OpenCase& c : challenge.cases) {
        if (!is_name_of_a_case(c.folder))
            problems.push_back(
                fmt::format("{}: folder must be a name such as case_0001, without a path, got \"{}\"",
                            file.string(), c.folder));
        if (!seen.insert(c.folder).second)
            problems.push_back(fmt::format("{}: folder {} is there twice", file.string(), c.folder));
    }
    if (!problems.empty()) throw InputError(problems);
}

}  // namespace

std::string open_challenge_text(const OpenChallenge& challenge) {
    Json cases = Json::array();
    for (const OpenCase& c : challenge.cases)
        cases.push_back({{"folder", c.folder}, {"candidates", c.candidates ? Json(*c.candidates) : Json()}});
    return Json{{"format", challenge_format},
                {"scene_sha256", challenge.scene},
                {"sealed_sha256", challenge.sealed},
                {"cases", cases}}
               .dump(1) +
           "\n";
}

OpenChallenge read_open_challenge(const std::filesystem::path& folder) {
    const auto file = folder / "challenge.json";
    const std::string text = read_file(file, "there is no challenge; `mcdem challenge make` makes one");
    try {
        const auto json = nlohmann::json::parse(text);
        if (json.at("format") != challenge_format)
            throw InputError(file.string() + ": made by another version; generate it again");
        OpenChallenge challenge{json.at("scene_sha256"), json.at("sealed_sha256"), {}};
        for (const auto& c : json.at("cases")) {
            challenge.cases.push_back({c.at("folder"), std::nullopt});
            if (!c.at("candidates").is_null())
                challenge.cases.back().candidates = c.at("candidates").get<std::vector<std::string>>();
        }
        expect_names(challenge, file);
        return challenge;
    } catch (const nlohmann::json::exception& error) {
        throw InputError(fmt::format("{}: not a challenge ({})", file.string(), error.what()));
    }
}

}  // namespace mcdem::challenge
