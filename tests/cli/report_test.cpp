// Reports from the command line.
#include <gtest/gtest.h>

#include "cli/cli_test.h"

namespace mcdem {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string page_at(const std::filesystem::path& file) { return bytes_of_file(file); }

/// An empty diagnosis.
const char* const bare_diagnosis =
    R"({"verdict": "no_gap", "gap": {"detected": false, "p_value": 0.5, "p_omnibus": 0.5, "p_directed": 0.5},
"where": [], "causes": [], "shrink": null, "detection_limits": [], "not_measured": ["<script>alert(1)</script>"],
"seconds": 1, "sentence": "", "where_threshold": null, "cells": [], "ranking": [], "nuisances": [],
"not_testable": [], "provenance": {}})";

TEST_F(CliTest, AReportIsOnePageOfARun) {
    expect_done(mcdem(run_words("a")));
    const auto report = mcdem({"report", "a", "--out", "a.html"});
    expect_done(report);
    EXPECT_EQ(report.out, "a.html\n");
    const auto page = page_at(path("a.html"));
    for (const char* part :
         {"<h2>The packing in 3D</h2>", "\"id\":\"top_force\"", "\"id\":\"force_distribution\"",
          "\"id\":\"coordination\"", "\"id\":\"scaling\"", "SHA-256 of run.h5", "packing seeds",
          "<h3>Top force</h3>", "<h3>Scaling law</h3>"})
        EXPECT_TRUE(page.find(part) != std::string::npos) << part;
}

TEST_F(CliTest, AReportMixesRunsDiagnosesAndAReference) {
    expect_done(mcdem(run_words("a")));
    std::filesystem::create_directory(path("d"));
    std::ofstream(path("d/diagnosis.json")) << bare_diagnosis;
    expect_done(
        mcdem({"report", "a", "d", "--out", "both.html", "--against", "a", "--setting", "elastic_sphere"}));
    const auto page = page_at(path("both.html"));
    for (const char* part :
         {"<p class=\"kicker\">Simulation</p>", "No detectable gap", "<h3>Against elastic_sphere</h3>",
          "&lt;script&gt;alert(1)&lt;/script&gt;", "experiment: d</p>"})
        EXPECT_TRUE(page.find(part) != std::string::npos) << part;
    EXPECT_TRUE(page.find("<script>alert") == std::string::npos);
    expect_done(mcdem({"report", "d/diagnosis.json", "--out", "alone.html"}));
    expect_bad_input(mcdem({"report", "d", "--out", "x.html", "--against", "a"}), "--against: needs a run");
}

TEST_F(CliTest, ScansThatAReportOmitsAreNamed) {
    expect_done(mcdem(run_words("a")));
    const auto whole = mcdem({"report", "a", "--out", "whole.html"});
    EXPECT_THAT(whole.err, Not(HasSubstr("scans")));
    const auto thinned = mcdem({"report", "a", "--out", "thinned.html", "--scans", "3"});
    expect_done(thinned);
    EXPECT_THAT(thinned.err, HasSubstr("Shown of every packing: 3 of 8 scans, evenly spread"));
    EXPECT_TRUE(page_at(path("thinned.html")).find("Shown of every packing: 3 of 8 scans") !=
                std::string::npos);
    EXPECT_LT(std::filesystem::file_size(path("thinned.html")),
              std::filesystem::file_size(path("whole.html")));
}

TEST_F(CliTest, NamesInAReportAreEscaped) {
    expect_done(mcdem(run_words("<b onclick=x>", {"--set", "name='</script><script>alert(1)</script>'"})));
    expect_done(mcdem({"report", "<b onclick=x>", "--out", "hostile.html"}));
    const auto page = page_at(path("hostile.html"));
    EXPECT_TRUE(page.find("<script>alert") == std::string::npos);
    EXPECT_TRUE(page.find("<b onclick") == std::string::npos);
    EXPECT_TRUE(page.find("&lt;/script&gt;&lt;script&gt;alert(1)") != std::string::npos);
    EXPECT_TRUE(page.find("&lt;b onclick=x&gt;") != std::string::npos);
}

TEST_F(CliTest, InputsThatCannotBeReportedAreExplained) {
    expect_bad_input(mcdem({"report", "nothing", "--out", "x.html"}), "nothing: must be a result folder");
    std::ofstream(path("wrong.json")) << "{}";
    expect_bad_input(mcdem({"report", "wrong.json", "--out", "x.html"}),
                     "wrong.json: must be a diagnosis.json");
    expect_bad_input(mcdem({"report", "none.json", "--out", "x.html"}), "none.json: no such file");
    EXPECT_FALSE(std::filesystem::exists(path("x.html")));
}

}  // namespace
}  // namespace mcdem
