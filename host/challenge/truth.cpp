#include "challenge/truth.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "core/input_file.h"
#include "core/sha256.h"
#include "diagnose/infer/json_numbers.h"

namespace mcdem::inline challenge {
namespace {

using nlohmann::json;
constexpr int truth_format = 1;

}  // namespace

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Hidden, name, amplitude)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ChallengeCase, folder, kind, effects, nuisances, struck, packing, seed)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Challenge, seed, scene_sha256, packing_seeds, cases)

std::string truth_text(const Challenge& challenge) {
    json text = challenge;
    text["format"] = truth_format;
    return text.dump(1) + "\n";
}

Challenge parse_truth(const std::string& text, const std::string& file_name) {
    try {
        const json truth = json::parse(text);
        if (truth.at("format") != truth_format) throw InputError(file_name + ": made by another version");
        return truth;
    } catch (const json::exception& error) {
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
