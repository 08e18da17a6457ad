// A page with charts: one HTML file that needs nothing else and is not allowed to ask for anything.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "report/page/text_table.h"

namespace mcdem::inline report {

using Json = nlohmann::ordered_json;

/// Text from anywhere, for a place where plotly.js understands tags and entities: shown as it stands.
std::string plot_text(const std::string& text);

/// A chart in the terms of plotly.js. Colours may be the page's variables, "var(--ink)"; page.js fills them
/// in.
struct Chart {
    std::string name;     ///< what it shows, one word: top_force
    std::string title;    ///< above it
    std::string caption;  ///< below it
    Json data = Json::array();
    Json layout = Json::object();
    std::string log_axes = "";  ///< those that a button turns logarithmic: "y", "xy", none
    int height = 440;           ///< [pixels]
    int min_width = 0;          ///< a narrower screen scrolls it [pixels]
};

/// Collects the parts of a page from top to bottom. Every text may come from anywhere.
class Page {
public:
    explicit Page(std::string title) : title_(std::move(title)) {}
    /// Before the heading of the first section.
    void lead(const std::string& kicker, const std::string& heading, const std::string& sentence);
    void section(const std::string& heading);
    void subheading(const std::string& text);
    void paragraph(const std::string& text);
    /// Under its heading; nothing where it has no rows.
    void table(const std::string& heading, const TextTable& table);
    void list(const std::vector<std::string>& texts);
    /// What a thing is called, and what is said of it.
    void definitions(const std::vector<std::pair<std::string, std::string>>& lines);
    /// A text of many lines, folded up under its heading.
    void folded(const std::string& heading, const std::string& text);
    /// Gives it an id of its own: its name, numbered from the second of a name on.
    void chart(const Chart& chart);
    /// The packing in space (packing_view.h).
    void packing(const Json& view, const std::string& caption);

    /// The whole file. `packed_library`: plotly.js as a gzip file.
    std::string html(const std::string& packed_library) const;

private:
    std::string new_id(const std::string& name);
    std::string title_, body_;
    std::vector<std::string> ids_;
    Json charts_ = Json::array(), packings_ = Json::array();
};

/// Writes the page with the library of the installation. Throws RunError where it cannot.
void write_page(const Page& page, const std::filesystem::path& file);

}  // namespace mcdem::report
