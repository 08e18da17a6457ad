// Reports from the command line.
#include <gtest/gtest.h>

#include "cli/cli_test.h"

namespace mcdem {
namespace {

using testing::HasSubstr;
using testing::Not;

/// An empty diagnosis.
const char* const bare_diagnosis =
    R"({"verdict": "no_gap", "gap": {"detected": false, "p_value": 0.5, "p_omnibus": 0.5, "p_directed": 0.5},
"where": [], "causes": [], "shrink": null, "detection_limits": [], "not_measured": ["<script>alert(1)</script>"],
"seconds": 1, "sentence": "", "where_threshold": null, "cells": [], "ranking": [], "nuisances": [],
"not_testable": [], "provenance": {}})";

TEST_F(CliTest, AReportShowsRunsDiagnosesAndAReference) {
    expect_done(mcdem(run_words("<b>", {"--set", "name='</script><script>alert(1)</script>'"})));
    std::filesystem::create_directory(path("d"));
    std::ofstream(path("d/diagnosis.json")) << bare_diagnosis;
    const auto report = line("report <b> d --out both.html --against <b> --setting elastic_sphere");
    expect_done(report);
    EXPECT_EQ(report.out, "both.html\n");
    EXPECT_THAT(report.err, Not(HasSubstr("scans")));
    const auto page = bytes_of_file(path("both.html"));
    for (const char* part :
         {"<h2>The packing in 3D</h2>", "\"id\":\"top_force\"", "\"id\":\"force_distribution\"",
          "\"id\":\"coordination\"", "\"id\":\"scaling\"", "SHA-256 of run.h5", "packing seeds",
          "<h3>Top force</h3>", "<h3>Scaling law</h3>", "<p class=\"kicker\">Simulation</p>",
          "No detectable gap", "<h3>Against elastic_sphere</h3>", "&lt;script&gt;alert(1)&lt;/script&gt;",
          "experiment: d</p>", "&lt;/script&gt;&lt;script&gt;alert(1)", "&lt;b&gt;"})
        EXPECT_TRUE(page.find(part) != std::string::npos) << part;
    for (const char* part : {"<script>alert", "<b>"})
        EXPECT_TRUE(page.find(part) == std::string::npos) << part;

    const auto thinned = line("report <b> --out thinned.html --scans 3");
    expect_done(thinned);
    const std::string omitted = "Shown of every packing: 3 of 8 scans";
    EXPECT_THAT(thinned.err, HasSubstr(omitted + ", evenly spread"));
    EXPECT_TRUE(bytes_of_file(path("thinned.html")).find(omitted) != std::string::npos);
}

TEST_F(CliTest, InputsThatCannotBeReportedAreExplained) {
    std::filesystem::create_directory(path("d"));
    std::ofstream(path("d/diagnosis.json")) << bare_diagnosis;
    std::ofstream(path("wrong.json")) << "{}";
    expect_done("report d/diagnosis.json --out alone.html");
    expect_refused("report d --out x.html --against a", "--against: needs a run");
    expect_refused("report nothing --out x.html", "nothing: must be a result folder");
    expect_refused("report wrong.json --out x.html", "wrong.json: must be a diagnosis.json");
    expect_refused("report none.json --out x.html", "none.json: no such file");
    EXPECT_FALSE(std::filesystem::exists(path("x.html")));
}

}  // namespace
}  // namespace mcdem
