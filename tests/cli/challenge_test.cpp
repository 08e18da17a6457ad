// A small challenge from its simulated experiments to its score: blind, sealed, without hints about the
// truth.
#include <zlib.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/tiny_challenge.h"
#include "core/sha256.h"
#include "diagnose/effects.h"
#include "ensemble/diagnosis/outside_effects.h"

namespace mcdem {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;
const Words score_words{"challenge", "score", "challenge", "answers", "--truth", "sealed/truth.json"};

/// Contents of all files below a folder, by path; compressed files are unpacked.
std::map<std::string, std::string> contents_of(const fs::path& folder) {
    std::map<std::string, std::string> contents;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        std::string& text = contents[fs::relative(entry.path(), folder)];
        const gzFile in = gzopen(entry.path().c_str(), "rb");
        char part[1 << 14];
        for (int read; (read = gzread(in, part, sizeof part)) > 0;)
            text.append(part, static_cast<std::size_t>(read));
        gzclose(in);
    }
    return contents;
}

/// Experiments and diagnoses are made once; the truth is not accessible during the diagnoses.
class ChallengeTest : public testing::Test {
protected:
    static void SetUpTestSuite() {
        if (!MCDEM_TEST_PYTHON) return;
        folder_ = new TestFolder;
        write_tiny_scene(folder_->path);
        made_ = new Finished(mcdem(make_challenge_words));
        fs::create_directories(path("sealed"));
        if (fs::exists(path("challenge/truth.json")))
            fs::rename(path("challenge/truth.json"), path("sealed/truth.json"));
        ran_ = new Finished(mcdem(run_challenge_words));
    }
    static void TearDownTestSuite() {
        delete folder_;
        delete made_;
        delete ran_;
    }
    void SetUp() override {
        NEEDS_PYTHON_MODULE();
        ASSERT_EQ(made_->exit_code, 0) << made_->err;
        ASSERT_EQ(ran_->exit_code, 0) << ran_->err;
    }

    static fs::path path(const std::string& name) { return folder_->path / name; }
    static Finished mcdem(const Words& words) { return run_program(folder_->path, words); }
    static nlohmann::json json_of(const std::string& name) {
        return nlohmann::json::parse(bytes_of_file(path(name)));
    }

    static inline TestFolder* folder_ = nullptr;
    static inline Finished *made_ = nullptr, *ran_ = nullptr;
};

TEST_F(ChallengeTest, SealIsThatOfTheTruth) {
    const std::string seal = Sha256().add(bytes_of_file(path("sealed/truth.json"))).hex();
    EXPECT_THAT(made_->out, HasSubstr(seal));
    EXPECT_EQ(json_of("challenge/challenge.json").at("sealed_sha256"), seal);
}

/// Cells of a column; `name` is not that of the first one.
Words column_of(const std::string& table, const std::string& name) {
    std::istringstream lines(table);
    std::string line, cell;
    std::getline(lines, line);
    const auto before = std::ranges::count(line.substr(0, line.find("," + name)), ',') + 1;
    Words cells;
    while (std::getline(lines, line)) {
        std::istringstream row(line);
        for (auto k = before; k >= 0; --k) std::getline(row, cell, ',');
        cells.push_back(cell);
    }
    return cells;
}

/// Sum of the contact forces at the plate over the measured force of the plate, over all scans.
double plate_contacts_over_reading(const std::string& contacts, const std::string& plate) {
    double sum = 0, reading = 0;
    const Words partner = column_of(contacts, "partner"), force = column_of(contacts, "fz_N");
    for (std::size_t c = 0; c < partner.size(); ++c)
        if (partner[c] == "plate") sum -= std::stod(force[c]);
    for (const std::string& cell : column_of(plate, "top_force_N")) reading += std::stod(cell);
    return sum / reading;
}

TEST_F(ChallengeTest, ExperimentsHaveTheEffectsOfTheTruth) {
    const auto truth = json_of("sealed/truth.json");
    ASSERT_EQ(truth.at("cases").size(), static_cast<std::size_t>(cases));
    for (const auto& c : truth.at("cases")) {
        auto tables = contents_of(path("challenge/" + c.at("folder").get<std::string>()));
        const std::string &plate = tables["plate.csv.gz"], &contacts = tables["contacts.csv.gz"];
        for (const auto& shift : c.at("nuisances"))
            if (shift.at("name") == "strain_offset") {
                const double plate_z = std::stod(column_of(plate, "plate_z_m").at(0));
                EXPECT_NEAR(plate_z - 0.0835, shift.at("amplitude").get<double>(), 1e-8) << c;
            }
        double bias = 0;
        for (const auto& effect : c.at("effects"))
            if (effect.at("name") == "force_bias") bias = effect.at("amplitude");
        // About 250 contacts with 5 % noise each and unequal forces; the weakest are not detected: 2 %.
        EXPECT_NEAR(plate_contacts_over_reading(contacts, plate), 1 + bias, 0.02) << c;
    }
}

TEST_F(ChallengeTest, EveryCaseIsDiagnosedWithoutTheTruth) {
    for (int k = 1; k <= cases; ++k) {
        const auto diagnosis = json_of("answers/case_000" + std::to_string(k) + ".json");
        EXPECT_TRUE(diagnosis.contains("verdict")) << diagnosis;
    }
}

TEST_F(ChallengeTest, IsScored) {
    auto words = score_words;
    words.push_back("--no-figures");
    const Finished scored = mcdem(words);
    ASSERT_EQ(scored.exit_code, 0) << scored.err;
    EXPECT_THAT(scored.out, HasSubstr("RMSE ranking"));
    const auto score = json_of("answers/score.json");
    EXPECT_EQ(score.at("cases"), cases);
    EXPECT_TRUE(score.at("not_diagnosed").empty());
    const auto& whole = score.at("methods").at(0);
    int counted = 0;
    for (const char* half : {"first_half", "scored_half"})
        for (const char* kind : {"false_alarms", "detected", "named_unknown", "named_outside_prior"})
            counted += whole.at(half).at(kind).at("of").get<int>();
    EXPECT_EQ(counted, cases);
    EXPECT_THAT(bytes_of_file(path("answers/score.md")), HasSubstr("| whole method"));
}

TEST_F(ChallengeTest, RefusesAModifiedTruth) {
    std::string truth = bytes_of_file(path("sealed/truth.json"));
    truth.replace(truth.find("\"none\""), 6, "\"pair\"");
    std::ofstream(path("sealed/touched.json")) << truth;
    auto words = score_words;
    words.back() = "sealed/touched.json";
    expect_bad_input(mcdem(words), "is not the truth that was sealed");
}

TEST_F(ChallengeTest, FilesGiveNoHintsAboutTheTruth) {
    const auto contents = contents_of(path("challenge"));
    EXPECT_EQ(contents.size(), 1u + 4u * cases);
    std::vector<std::string> words{"none", "pair", "unknown", "outside", "seed", "amplitude", "struck"};
    for (const Effect& effect : effects()) words.emplace_back(effect.name);
    for (const OutsideEffect& effect : outside_effects()) words.emplace_back(effect.name);
    std::string settings;
    for (const auto& [name, text] : contents) {
        if (name == "challenge.json") continue;
        const fs::path file = name;
        // Words of any experiment.toml, which states grains.friction.
        if (file.filename() == "experiment.toml") {
            const std::string nameless = text.substr(text.find('['));
            if (settings.empty()) settings = nameless;
            EXPECT_EQ(nameless, settings) << name;
            EXPECT_THAT(nameless, HasSubstr("youngs_modulus = 23300.0"));
            continue;
        }
        for (const std::string& word : words)
            EXPECT_EQ(text.find(word), std::string::npos) << name << ": " << word;
    }
}

TEST_F(ChallengeTest, OpenFileListsCandidatesOnlyIfSomeAreStruck) {
    const auto challenge = json_of("challenge/challenge.json");
    int with_candidates = 0;
    for (const auto& c : challenge.at("cases")) {
        EXPECT_EQ(c.size(), 2u) << c;
        with_candidates += !c.at("candidates").is_null();
    }
    EXPECT_EQ(with_candidates, 1);
    const auto truth = json_of("sealed/truth.json");
    for (const auto& c : truth.at("cases"))
        for (const auto& struck : c.at("struck"))
            for (const auto& open : challenge.at("cases"))
                if (open.at("folder") == c.at("folder")) {
                    EXPECT_EQ(open.at("candidates").dump().find(struck.dump()), std::string::npos);
                }
    EXPECT_EQ(challenge.size(), 4u) << challenge;
}

TEST_F(ChallengeTest, ResumesAfterAnInterruption) {
    const auto before = contents_of(path("challenge"));
    fs::copy(path("sealed/truth.json"), path("challenge/truth.json"));
    fs::remove(path("challenge/case_0004/experiment.toml"));
    fs::remove(path("challenge/case_0004/plate.csv.gz"));
    fs::last_write_time(path("challenge/case_0002/plate.csv.gz"), {});
    const Finished again = mcdem(make_challenge_words);
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(again.out, made_->out);
    EXPECT_EQ(fs::last_write_time(path("challenge/case_0002/plate.csv.gz")), fs::file_time_type{});
    fs::remove(path("challenge/truth.json"));
    EXPECT_EQ(contents_of(path("challenge")), before);

    const std::string kept = bytes_of_file(path("answers/case_0001.json"));
    EXPECT_EQ(mcdem(run_challenge_words).exit_code, 0);
    EXPECT_EQ(bytes_of_file(path("answers/case_0001.json")), kept);  // its time would differ
}

TEST_F(ChallengeTest, RefusesAFolderOfAnotherChallenge) {
    auto words = make_challenge_words;
    words[6] = "4";
    words.insert(words.end(), {"--truth", "sealed/truth.json"});
    expect_bad_input(mcdem(words), "is of another challenge");
}

TEST_F(ChallengeTest, RefusesAnotherScene) {
    auto words = run_challenge_words;
    words.insert(words.end(), {"--set", "grains.friction=0.1"});
    expect_bad_input(mcdem(words), "is not the scene that");
}

}  // namespace
}  // namespace mcdem
