// A page with charts: one self-contained HTML file without network access.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "report/page/text_table.h"

namespace mcdem::inline report {

using Json = nlohmann::ordered_json;

/// A chart, which page_charts.js draws with plotly.js.
struct Chart {
    std::string name;           ///< one word: top_force
    std::string title;          ///< above it
    std::string caption;        ///< below it
    Json values = {};           ///< as in figures.json
    std::string log_axes = "";  ///< axes with a button for a logarithmic scale: "y", "xy", or none
    int height = 440;           ///< [pixels]
    int min_width = 0;          ///< narrower screens scroll [pixels]
};

/// Collects the parts of a page from top to bottom. All texts are escaped.
class Page {
public:
    explicit Page(std::string title) : title_(std::move(title)) {}
    /// Head of the page, before the first section.
    void lead(const std::string& kicker, const std::string& heading, const std::string& sentence);
    void section(const std::string& heading);
    void subheading(const std::string& text);
    void paragraph(const std::string& text);
    /// A table under its heading; nothing if it has no rows.
    void table(const std::string& heading, const TextTable& table);
    void list(const std::vector<std::string>& texts);
    void definitions(const std::vector<std::pair<std::string, std::string>>& lines);
    /// A long text, collapsed under its heading.
    void folded(const std::string& heading, const std::string& text);
    /// Adds a chart. Its id is its name, with a number if the name is repeated.
    void chart(const Chart& chart);
    /// The 3D view of a packing (packing_view.h).
    void packing(const Json& view, const std::string& caption);

    /// The complete file. `packed_library`: plotly.js as gzip.
    std::string html(const std::string& packed_library) const;

private:
    std::string new_id(const std::string& name);
    std::string title_, body_;
    std::vector<std::string> ids_;
    Json charts_ = Json::array(), packings_ = Json::array();
};

/// Writes the page with the installed library. Throws RunError if that fails.
void write_page(const Page& page, const std::filesystem::path& file);

/// plotly.js, compressed with gzip. It is searched in $MCDEM_SHARE, in share/mcdem next to the program or
/// next to its folder, and in the installation folder. Throws RunError if it is not found.
std::string packed_plotting_library();

}  // namespace mcdem::report
