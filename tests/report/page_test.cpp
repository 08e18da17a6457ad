#include "report/page/page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.h"
#include "core/sha256.h"
#include "report/folder.h"
#include "report/page_text.h"

namespace mcdem {
namespace {

using testing::HasSubstr;

const std::string hostile =
    "</script><script>alert(1)</script><img src=x onerror=\"alert('2')\"> & ' \" \x01\x1b[2J";

/// A page with this text in all positions where a page has text.
Page plain_page(const std::string& text) {
    Page page(text);
    page.lead(text, text, text);
    page.section(text);
    page.subheading(text);
    page.paragraph(text);
    page.table(text, {{{text, Align::left}}, {{text}}, {text}});
    page.list({text});
    page.definitions({{text, text}});
    page.folded(text, text + "\nsecond line");
    page.chart({.name = "a_chart", .title = text, .caption = text, .values = {{"text", text}}});
    page.packing({{"settings", {{{"label", text}}}}}, text);
    return page;
}

TEST(Page, texts_are_shown_and_not_executed_in_any_position) {
    const TestFolder folder;
    const auto page = plain_page(hostile).html("library");
    EXPECT_TRUE(well_formed(page, folder.path));
    EXPECT_FALSE(contains(page, "<script>alert"));
    EXPECT_FALSE(contains(page, "<img src=x"));
    EXPECT_FALSE(contains(markup_of(page), "\x1b"));
    EXPECT_EQ(all_matches(page, "(<script)").size(), 3u);  // content, library, the page's own script
    EXPECT_EQ(all_matches(page, "(</script)").size(), 3u);
    const auto content = content_of(page);
    EXPECT_EQ(content["charts"][0]["values"]["text"], hostile);  // complete, as text
    EXPECT_EQ(content["packings"][0]["view"]["settings"][0]["label"], hostile);
}

TEST(Page, the_check_of_tags_finds_an_unclosed_one) {
    const TestFolder folder;
    EXPECT_FALSE(well_formed(plain_page("text").html("") + "</p>", folder.path));
    EXPECT_FALSE(well_formed("<p><b></p></b>", folder.path));
}

TEST(Page, invalid_utf8_is_replaced) {
    const auto page = plain_page("M\xfcller").html("");
    EXPECT_THAT(content_of(page)["charts"][0]["values"]["text"].get<std::string>(),
                HasSubstr("M\xEF\xBF\xBDller"));
}

/// Browsers enforce this policy: only the script with this digest is executed, and no address may be loaded.
TEST(Page, policy_allows_only_its_script_and_no_address) {
    const auto page = plain_page("text").html("library");
    const auto begin = page.rfind("<script>") + 8, end = page.rfind("</script>");
    const auto hex = Sha256().add(page.substr(begin, end - begin)).hex();
    const auto policies = all_matches(page, "Content-Security-Policy\" content=\"([^\"]*)");
    ASSERT_EQ(policies.size(), 1u);
    const auto& policy = *policies.begin();
    EXPECT_THAT(policy, HasSubstr("default-src 'none'"));
    EXPECT_FALSE(contains(policy, "http"));
    EXPECT_FALSE(contains(policy, "script-src 'unsafe-inline'"));
    const auto hashes = all_matches(policy, "'sha256-([^']*)'");
    ASSERT_EQ(hashes.size(), 1u);
    EXPECT_EQ(hashes.begin()->size(), 44u);
    const TestFolder folder;
    const auto check =
        "python3 -c 'import base64, sys; sys.exit(base64.b64decode(sys.argv[1]).hex() != sys.argv[2])' '" +
        *hashes.begin() + "' " + hex;
    EXPECT_EQ(std::system(check.c_str()), 0);
}

TEST(Page, loads_no_other_files) {
    const auto markup = markup_of(plain_page("text").html("library"));
    for (const char* loads : {" src=", " href=", "<link", "@import", "url(", "<iframe"})
        EXPECT_FALSE(contains(markup, loads)) << loads;
}

TEST(Page, charts_with_the_same_name_have_unique_ids) {
    Page page("two");
    for (int i = 0; i < 3; ++i) page.chart({.name = "where", .title = "", .caption = ""});
    const auto text = page.html("");
    for (const char* id : {"where", "where_2", "where_3"})
        EXPECT_TRUE(contains(text, "id=\"" + std::string(id) + "\"")) << id;
    EXPECT_EQ(content_of(text)["charts"][2]["id"], "where_3");
}

TEST(Page, line_breaks_in_texts_are_kept) {
    Page page("scene");
    page.folded("The scene", "[box]\nsize_x = 1\t# <wide>\n");
    EXPECT_TRUE(contains(page.html(""), "<pre>[box]\nsize_x = 1 # &lt;wide&gt;\n"));
}

TEST(Page, contains_the_installed_plotting_library) {
    const TestFolder folder;
    write_page(plain_page("text"), folder.path / "page.html");
    EXPECT_GT(std::filesystem::file_size(folder.path / "page.html"),
              packed_plotting_library().size() * 4 / 3);
    EXPECT_LT(std::filesystem::file_size(folder.path / "page.html"), 4'000'000u);
    EXPECT_THROW(write_page(plain_page("text"), folder.path / "no/folder/page.html"), RunError);
}

TEST(PlottingLibrary, if_missing_the_message_names_the_searched_paths_and_a_remedy) {
    const TestFolder folder;
    ::setenv("MCDEM_SHARE", folder.path.c_str(), 1);
    std::string said;
    try {
        packed_plotting_library();
    } catch (const RunError& error) {
        said = error.what();
    }
    std::ofstream(folder.path / "plotly.js.gz") << "no gzip file";
    EXPECT_THROW(packed_plotting_library(), RunError);
    std::ofstream(folder.path / "plotly.js.gz") << "\x1f\x8b and so on";
    EXPECT_EQ(packed_plotting_library(), "\x1f\x8b and so on");
    ::unsetenv("MCDEM_SHARE");
    EXPECT_THAT(said, HasSubstr("plotly.js.gz, is in none of " + folder.path.string()));
    EXPECT_THAT(said, HasSubstr("install python3-plotly"));
}

}  // namespace
}  // namespace mcdem
