#include "report/diagnosis/diagnosis_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.h"
#include "report/diagnosis_samples.h"
#include "report/folder.h"
#include "report/page_text.h"

namespace mcdem {
namespace {

std::string page_of(const Diagnosis& diagnosis, const std::string& name = "") {
    Page page("diagnosis");
    add_diagnosis(page, diagnosis, name);
    return page.html("library");
}

std::set<std::string> names_in(const std::filesystem::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.insert(entry.path().filename());
    return names;
}

TEST(DiagnosisPage, has_its_charts) {
    std::vector<std::string> names;
    const auto content = content_of(page_of(samples::diagnosis(Verdict::group)));
    for (const auto& chart : content["charts"]) names.push_back(chart["id"]);
    EXPECT_THAT(names, testing::ElementsAre("where", "which", "how_far", "gap_left"));
}

TEST(DiagnosisPage, has_all_numbers) {
    const auto page = page_of(samples::diagnosis(Verdict::group), "out/diagnosis");
    for (const char* number : {"p = 0.004",
                               "p = 0.013",
                               "p = 0.002",
                               "0.264 ± 0.024 mJ/m²",
                               "0.332 ± 0.052",
                               "37 %",
                               "71 %",
                               "18.2",  // causes
                               "0.08 mJ/m²",
                               "4 kg/m³",
                               ">not detectable<",
                               "85 %",  // limits
                               "413",
                               "140",
                               "0.874",
                               "0.991",
                               "0.812",
                               "0.143",
                               "0.421",
                               "0.187",
                               "0.0312",
                               "0.0089",  // shrink
                               "66 %",
                               "51 to 78 %",
                               "12 %",
                               "64 %",
                               "+0.18 ± 0.12 kPa",
                               "± 0.5 kPa",
                               "-0.021 ± 0.014",  // nuisances
                               "-6.6",
                               "21 to 27 mm",
                               "1834 s",
                               "hydrogel.toml",
                               "5f70bf18a086007016e948b04aed3b82103a36bea41755b6cddfaf10ace3c6ef"})
        EXPECT_TRUE(contains(markup_of(page), number)) << number;
    for (const char* words : {"<li>forces on the side walls: would tell", "<li>diameters of single grains",
                              "cross_contact: the scene", "unloading, and loading", ": out/diagnosis</p>"})
        EXPECT_TRUE(contains(page, words)) << words;
}

TEST(DiagnosisPage, hostile_texts_are_shown_and_not_executed) {
    const TestFolder folder;
    const std::string hostile =
        "<script>alert(1)</script>\"'&`touch pwned1`'; system('touch pwned2') %s%n \\ \x01";
    const auto diagnosis = samples::with_texts(samples::diagnosis(Verdict::effect), hostile);
    const auto page = page_of(diagnosis, hostile);
    EXPECT_FALSE(contains(page, "<script>alert"));
    EXPECT_TRUE(contains(page, "&lt;script&gt;alert(1)&lt;/script&gt;&quot;&#39;&amp;`touch pwned1`"));
    EXPECT_TRUE(well_formed(page, folder.path));
}

TEST(DiagnosisPage, every_verdict_has_a_page_also_without_charts) {
    const TestFolder folder;
    std::set<std::string> headings;
    for (const auto verdict : samples::all_verdicts) {
        const auto page = page_of(samples::diagnosis(verdict));
        EXPECT_TRUE(well_formed(page, folder.path));
        headings.insert(*all_matches(page, "<h1>([^<]*)").begin());
        Diagnosis bare;
        bare.verdict = verdict;
        EXPECT_TRUE(well_formed(page_of(bare), folder.path));
        EXPECT_TRUE(content_of(page_of(bare))["charts"].empty());
    }
    EXPECT_EQ(headings.size(), samples::all_verdicts.size());
}

TEST(DiagnosisPage, is_a_single_file) {
    const TestFolder folder;
    const auto diagnosis = samples::diagnosis(Verdict::group);
    write_diagnosis_page(diagnosis, folder.path / "diagnosis.html");
    EXPECT_EQ(names_in(folder.path), std::set<std::string>{"diagnosis.html"});
}

TEST(DiagnosisPage, requires_a_folder) {
    const auto diagnosis = samples::diagnosis(Verdict::no_gap);
    EXPECT_THROW(write_diagnosis_page(diagnosis, "/nonexistent/folder/page.html"), RunError);
}

}  // namespace
}  // namespace mcdem
