#include "challenge/files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <set>

#include "core/errors.h"
#include "core/input_file.h"
#include "diagnose/infer/json_numbers.h"

namespace mcdem::inline challenge {
namespace {

using nlohmann::json;
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

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(OpenCase, folder, candidates)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(OpenChallenge, scene_sha256, sealed_sha256, cases)

std::string open_challenge_text(const OpenChallenge& challenge) {
    json text = challenge;
    text["format"] = challenge_format;
    return text.dump(1) + "\n";
}

OpenChallenge read_open_challenge(const std::filesystem::path& folder) {
    const auto file = folder / "challenge.json";
    const std::string text = read_file(file, "there is no challenge; `mcdem challenge make` makes one");
    try {
        const json open = json::parse(text);
        if (open.at("format") != challenge_format)
            throw InputError(file.string() + ": made by another version; generate it again");
        const OpenChallenge challenge = open;
        expect_names(challenge, file);
        return challenge;
    } catch (const json::exception& error) {
        throw InputError(fmt::format("{}: not a challenge ({})", file.string(), error.what()));
    }
}

}  // namespace mcdem::challenge
