// One kind of work per folder: a second command in the folder of a running challenge or run is refused.
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/tiny_challenge.h"
#include "io/result_folder.h"

namespace mcdem {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

const char* const alone = "another program is writing there: wait for it";
const char* const not_shared = "another program is writing there alone, which cannot be shared";
const char* const shared = "other programs share work there: wait for them";

const std::string make_one =
    "challenge make tiny.toml --none 1 --pairs 0 --per-effect 0 --unknown 0 --outside 0 --packings 2 --out ";

class ChallengeFolderTest : public CliTest {
protected:
    void SetUp() override {
        NEEDS_PYTHON_MODULE();
        write_tiny_scene(folder_.path);
        expect_done(make_one + "challenge --effects friction,force_bias");
    }
    static Words challenge_words(const std::string& more = "") {
        Words words = with(run_challenge_words, more);
        *(std::ranges::find(words, "--out") + 1) = "out";
        return words;
    }
    /// A challenge that is blocked in the middle and holds its folder until released.
    std::unique_ptr<Child> held_challenge(const std::string& more = "") const {
        auto child = std::make_unique<Child>(folder_.path, challenge_words(more), held_after(100));
        wait_until_held(*child);
        return child;
    }
    using CliTest::expect_refused;
    void expect_refused(const Words& words, const std::string& problem) const {
        expect_bad_input(mcdem(words), problem);
    }
};

TEST_F(ChallengeFolderTest, ASecondProcessIsRefusedWhileOneAnswers) {
    const auto one = held_challenge();
    expect_refused(challenge_words(), alone);
    expect_refused(run_words("out"), alone);
    for (const char* how : {"--part=1/2", "--merge"}) {
        expect_refused(challenge_words(how), not_shared);
        expect_refused(run_words("out", {how}), not_shared);
    }
    let_go_on(*one);
    expect_done(one->wait());
    for (const Words& more : {Words{}, {"--resume"}, {"--part=1/2"}, {"--merge"}})
        expect_refused(run_words("out", more), "holds the diagnoses of a challenge");
    EXPECT_TRUE(file_of_a_run(path("out")).empty());
}

TEST_F(ChallengeFolderTest, OnlyOneProcessMakesAChallenge) {
    Child one(folder_.path, split(make_one + "other"), held_after(100));
    wait_until_held(one);
    expect_refused(make_one + "other", alone);
    expect_refused(run_words("other"), alone);
    let_go_on(one);
    expect_done(one.wait());
}

TEST_F(ChallengeFolderTest, NothingIsWrittenOutsideTheFolderOrBeforeItIsComplete) {
    const std::string challenge = bytes_of_file(path("challenge/challenge.json"));
    for (const std::string& name :
         {path("config").string(), std::string("../config"), std::string("case_1/../../config"),
          std::string("sub/case_0001"), std::string("library"), std::string(".."), std::string()}) {
        std::string other = challenge;
        other.replace(other.find("case_0001"), 9, name);
        std::ofstream(path("challenge/challenge.json")) << other;
        expect_refused(challenge_words(), "challenge.json: folder must be a name such as case_0001");
        EXPECT_FALSE(fs::exists(path("out")));
    }
    std::ofstream(path("challenge/challenge.json")) << challenge;
    fs::remove(path("challenge/case_0001/experiment.toml"));
    expect_refused(challenge_words(), "challenge: case_0001 is not made yet");
}

/// Two diagnoses at once: both give a verdict, and the library that is written first is kept.
TEST_F(ChallengeFolderTest, ALibraryIsWrittenOnce) {
    const std::string words =
        "diagnose tiny.toml --experiment challenge/case_0001 --library l --replicates 8 --pairs 2"
        " --confirmations 0 --candidates friction --no-figures --out ";
    Child first(folder_.path, split(words + "first"), held_after(100));
    wait_until_held(first);
    expect_done(words + "second");
    const std::string written = bytes_of_file(path("l"));
    let_go_on(first);
    const Finished finished = first.wait();
    expect_done(finished);
    EXPECT_THAT(finished.err, HasSubstr("l: another process wrote this library first; it is kept"));
    EXPECT_TRUE(fs::exists(path("first/diagnosis.json")));
    EXPECT_EQ(bytes_of_file(path("l")), written);
}

TEST_F(ChallengeFolderTest, ASingleProcessIsRefusedWhileOthersShareTheChallenge) {
    const auto one = held_challenge("--part=1/1");
    expect_refused(challenge_words(), shared);
    expect_refused(run_words("out"), shared);
    expect_refused(run_words("out", {"--part=1/2"}), "holds the diagnoses of a challenge");
    let_go_on(*one);
    expect_done(one->wait());
    EXPECT_TRUE(fs::exists(path("out/case_0001.json")));
    EXPECT_TRUE(file_of_a_run(path("out")).empty());
}

TEST_F(ChallengeFolderTest, AnswersInPartsAreTheSame) {
    Words alone = challenge_words();
    *(std::ranges::find(alone, "--out") + 1) = "alone";
    *(std::ranges::find(alone, "--library") + 1) = "alone.json";
    expect_done(mcdem(alone));
    int computed = 0;
    for (std::string missing; !(missing = mcdem(challenge_words("--missing")).out).empty();) {
        if (computed == 0) {
            EXPECT_FALSE(missing.starts_with("1/")) << "a case before the library";
            EXPECT_EQ(mcdem(challenge_words("--merge")).exit_code, 1);
        }
        std::istringstream numbers(missing);
        for (std::string number; numbers >> number; ++computed)
            expect_done(mcdem(challenge_words("--part " + number)));
        ASSERT_LT(computed, 100);
    }
    expect_done(mcdem(challenge_words("--merge")));
    EXPECT_GT(computed, 1);
    EXPECT_EQ(bytes_of_file(path("library.json")), bytes_of_file(path("alone.json")));
    for (const char* file : {"evidence/case_0001.json", "findings/case_0001.json"})
        EXPECT_EQ(bytes_of_file(path("out") / file), bytes_of_file(path("alone") / file));
}

TEST_F(ChallengeFolderTest, OtherInputsThanAtTheStartAreRefused) {
    const Words words = challenge_words();
    expect_done(mcdem(words));
    const auto changed = [&](const std::string& option, const std::string& value) {
        Words other = words;
        *(std::ranges::find(other, option) + 1) = value;
        return other;
    };
    for (const char* option : {"--replicates", "--confirmations", "--library-packings"})
        expect_refused(changed(option, "4"), std::string("out: was begun with another ") + option);
    fs::remove(path("out/case_0001.json"));
    auto library = nlohmann::json::parse(bytes_of_file(path("library.json")));
    library.erase("sha256");  // as before the content is changed
    library["provenance"]["device"] = "another";
    std::ofstream(path("changed.json")) << library;
    expect_refused(changed("--library", "changed.json"),
                   "out/library.json: is another library than changed.json");
    std::ofstream(path("out/manifest.json")) << "{";
    expect_refused(words, "manifest.json: is damaged");
}

TEST_F(ChallengeFolderTest, IsRefusedInTheFolderOfARun) {
    {
        const auto run = ResultFolder::create(path("out"));  // as for a run before its first checkpoint
        expect_refused(challenge_words(), alone);
        for (const char* how : {"--part=1/2", "--merge"}) expect_refused(challenge_words(how), not_shared);
    }
    {
        const FolderLock worker(path("out"), FolderLock::Use::shared);
        fs::create_directory(parts_folder(path("out")));
        expect_refused(challenge_words(), shared);
        for (const char* how : {"--part=1/2", "--merge"})
            expect_refused(challenge_words(how), "holds a run (parts)");
    }
    expect_refused(challenge_words(), "holds a run (parts)");
    EXPECT_FALSE(fs::exists(path("out/evidence")));
}

}  // namespace
}  // namespace mcdem
