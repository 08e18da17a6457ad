// Code that makes diagnoses cannot read sealed data: its sources do not include the header, directly or
// indirectly.
#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "ensemble/small_scene.h"

namespace mcdem {
namespace {

namespace fs = std::filesystem;
const fs::path host = fs::path(MCDEM_SOURCE_DIR) / "host";

/// All headers of the project that a source includes, directly or indirectly, and their source files.
std::set<std::string> reached_from(const std::set<std::string>& roots) {
    static const std::regex include("#include \"([^\"]+)\"");
    std::set<std::string> seen;
    std::vector<std::string> open(roots.begin(), roots.end());
    while (!open.empty()) {
        const std::string name = open.back();
        open.pop_back();
        if (!fs::exists(host / name) || !seen.insert(name).second) continue;
        const std::string text = bytes_of_file(host / name);
        for (std::sregex_iterator match(text.begin(), text.end(), include), end; match != end; ++match)
            open.push_back((*match)[1]);
        if (name.ends_with(".h")) open.push_back(name.substr(0, name.size() - 1) + "cpp");
    }
    return seen;
}

TEST(ChallengeBlindness, DiagnosingCodeDoesNotIncludeTheTruth) {
    const auto reached = reached_from({"challenge/run.cpp", "ensemble/diagnosis/diagnose_experiment.cpp"});
    EXPECT_TRUE(reached.contains("diagnose/infer/proposals.cpp")) << "the search itself must search";
    for (const char* sealed : {"challenge/truth.h", "challenge/case.h", "challenge/plan.h"})
        EXPECT_FALSE(reached.contains(sealed)) << sealed;
}

TEST(ChallengeBlindness, ScoringCodeIncludesTheTruth) {
    EXPECT_TRUE(reached_from({"cli/challenge/challenge_score.cpp"}).contains("challenge/truth.h"));
}

TEST(ChallengeBlindness, RunningCodeDoesNotMentionTheTruth) {
    for (const char* name :
         {"challenge/run.cpp", "challenge/run.h", "cli/challenge/challenge_run.cpp",
          "ensemble/diagnosis/diagnose_experiment.cpp", "challenge/files.cpp", "challenge/results.cpp"})
        EXPECT_EQ(bytes_of_file(host / name).find("truth"), std::string::npos) << name;
}

}  // namespace
}  // namespace mcdem
