#include "report/diagnosis_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>

#include "core/errors.h"
#include "report/diagnosis_samples.h"
#include "report/folder.h"
#include "report/html.h"

namespace mcdem {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string text_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Pages are too long for the message of a failed test.
bool contains(const std::string& page, const std::string& part) {
    return page.find(part) != std::string::npos;
}

std::multiset<std::string> all_matches(const std::string& text, const std::string& pattern) {
    const std::regex regex(pattern);
    std::multiset<std::string> found;
    for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match)
        found.insert((*match)[1]);
    return found;
}

std::set<std::string> names_in(const std::filesystem::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.insert(entry.path().filename());
    return names;
}

/// Python's parser takes the page, but for its first line and unclosed <meta>, as XML: every tag is closed in
/// its place.
bool well_formed(const std::string& page, const std::filesystem::path& folder) {
    const auto xml = std::regex_replace(page.substr(page.find('\n')), std::regex("(<meta[^>]*)>"), "$1/>");
    std::ofstream(folder / "page.xml") << xml;
    const auto command = "python3 -c 'import sys, xml.dom.minidom as m; m.parse(sys.argv[1])' '" +
                         (folder / "page.xml").string() + "'";
    const bool parsed = std::system(command.c_str()) == 0;
    std::filesystem::remove(folder / "page.xml");
    return parsed;
}

/// The page of one sample with its pictures, drawn once for all tests.
struct DrawnSample : testing::Test {
    static void SetUpTestSuite() {
        folder = new TestFolder;
        files = write_diagnosis_page(samples::diagnosis(Verdict::group), folder->path);
        page = text_of(folder->path / "diagnosis.html");
    }
    static void TearDownTestSuite() { delete folder; }
    static inline TestFolder* folder = nullptr;
    static inline std::vector<std::filesystem::path> files;
    static inline std::string page;
};

TEST_F(DrawnSample, leaves_the_page_and_its_pictures) {
    std::set<std::string> expected{"diagnosis.html"};
    for (const char* name : {"where", "which", "how_far"})
        for (const char* ending : {".png", ".svg", ".csv", ".gp"})
            expected.insert(std::string(name) + ending);
    EXPECT_EQ(names_in(folder->path), expected);
    ASSERT_EQ(files.size(), 4u);
    EXPECT_EQ(files[0].filename(), "diagnosis.html");
    for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(files[i].extension(), ".png");
}

TEST_F(DrawnSample, needs_nothing_from_anywhere) {
    EXPECT_FALSE(contains(page, "http"));
    for (const char* loads : {"<script", " src=", "<link", "@import", "url(", "<iframe", "<image", "<img"})
        EXPECT_FALSE(contains(page, loads)) << loads;
    for (const auto& target : all_matches(page, "href=[\"']([^\"']*)")) EXPECT_EQ(target[0], '#') << target;
}

TEST_F(DrawnSample, has_three_pictures_whose_ids_are_unique_and_found) {
    EXPECT_EQ(all_matches(page, "(<svg )").size(), 3u);
    const auto ids = all_matches(page, " id=[\"']([^\"']*)");
    EXPECT_GT(ids.size(), 30u);
    for (const auto& id : ids) EXPECT_EQ(ids.count(id), 1u) << id;
    for (const auto& target : all_matches(page, "href=[\"']#([^\"']*)"))
        EXPECT_EQ(ids.count(target), 1u) << target;
}

TEST_F(DrawnSample, is_well_formed) {
    EXPECT_TRUE(well_formed(page, folder->path));
    EXPECT_FALSE(well_formed(page + "</svg>", folder->path));
}

TEST_F(DrawnSample, follows_a_dark_screen) {
    for (const char* fixed : {"#ffffff\"", "fill=\"black\"", "rgb(34,34,34)", "rgb( 34,  34,  34)",
                              "rgb(221, 221, 221)", "color=\"black\""})
        EXPECT_FALSE(contains(page, fixed)) << fixed;
    EXPECT_TRUE(contains(page, "fill=\"var(--ink)\""));
    EXPECT_TRUE(contains(page, "stroke=\"var(--grid)\""));
}

TEST_F(DrawnSample, has_all_numbers) {
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
                               ">never shows<",
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
        EXPECT_TRUE(contains(page, number)) << number;
    for (const char* words : {"<li>forces on the side walls: would tell", "<li>diameters of single grains",
                              "cross_contact: the scene", "unloading, and loading"})
        EXPECT_TRUE(contains(page, words)) << words;
}

TEST(DiagnosisPage, hostile_texts_are_shown_and_never_run) {
    const TestFolder folder;
    const std::string hostile =
        "<script>alert(1)</script>\"'&`touch pwned1`'; system('touch pwned2') %s%n \\ \x01";
    write_diagnosis_page(samples::with_texts(samples::diagnosis(Verdict::effect), hostile), folder.path);
    const auto page = text_of(folder.path / "diagnosis.html");
    EXPECT_FALSE(contains(page, "<script"));
    EXPECT_TRUE(contains(page, "&lt;script&gt;alert(1)&lt;/script&gt;&quot;&#39;&amp;`touch pwned1`"));
    EXPECT_TRUE(well_formed(page, folder.path));
    for (const auto& name : names_in(folder.path)) EXPECT_THAT(name, Not(HasSubstr("pwned")));
    for (const auto& name : names_in(std::filesystem::current_path()))
        EXPECT_THAT(name, Not(HasSubstr("pwned")));
}

TEST(DiagnosisPage, every_verdict_has_a_page_of_its_own_even_without_pictures) {
    const TestFolder folder;
    std::set<std::string> titles;
    for (const auto verdict : samples::all_verdicts) {
        const auto page = diagnosis_page(samples::diagnosis(verdict), {});
        EXPECT_TRUE(well_formed(page, folder.path));
        titles.insert(*all_matches(page, "<h1>([^<]*)").begin());
        Diagnosis bare;
        bare.verdict = verdict;
        EXPECT_TRUE(well_formed(diagnosis_page(bare, {}), folder.path));
    }
    EXPECT_EQ(titles.size(), samples::all_verdicts.size());
}

TEST(DiagnosisPage, needs_a_folder) {
    EXPECT_THROW(write_diagnosis_page(samples::diagnosis(Verdict::no_gap), "/nonexistent/folder"), RunError);
}

TEST(InlineSvg, keeps_texts_and_refuses_what_is_none) {
    const auto svg = inline_svg(
        "<?xml?>\n<svg xmlns=\"x\">\n<title>t</title><g id='a' fill = 'rgb( 34,  34,  34)'/>"
        "<use xlink:href='#a'/><text>id='a' > url(#a) black</text></svg>\n",
        "p", "a \"b\"");
    EXPECT_EQ(svg,
              "<svg role=\"img\" aria-label=\"a &quot;b&quot;\">\n<g id=\"p-a\" fill=\"var(--ink)\"/>"
              "<use href=\"#p-a\"/><text>id='a' > url(#a) black</text></svg>\n");
    EXPECT_THROW(inline_svg("no picture", "p", ""), RunError);
    EXPECT_THROW(inline_svg("<svg><g id='a", "p", ""), RunError);
}

}  // namespace
}  // namespace mcdem
