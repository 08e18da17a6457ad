#include "report/page/html.h"

#include <fmt/format.h>

#include "report/page/labels.h"

namespace mcdem::inline report {

std::string html_text(const std::string& text) {
    std::string safe;
    for (const char c : one_line(text)) switch (c) {
            case '&':
                safe += "&amp;";
                break;
            case '<':
                safe += "&lt;";
                break;
            case '>':
                safe += "&gt;";
                break;
            case '"':
                safe += "&quot;";
                break;
            case '\'':
                safe += "&#39;";
                break;
            default:
                safe += c;
        }
    return safe;
}

std::string html_table(const TextTable& table) {
    if (table.rows.empty()) return "";
    const auto cell = [&](const char* tag, std::size_t column, const std::string& text) {
        const auto left = table.columns[column].align == Align::left ? " class=\"left\"" : "";
        return fmt::format("<{0}{1}>{2}</{0}>", tag, left, html_text(text));
    };
    std::string html = "<div class=\"wide\"><table>\n<thead><tr>";
    for (std::size_t c = 0; c < table.columns.size(); ++c) html += cell("th", c, table.columns[c].title);
    html += "</tr></thead>\n<tbody>\n";
    for (const auto& row : table.rows) {
        html += "<tr>";
        for (std::size_t c = 0; c < row.size(); ++c) html += cell("td", c, row[c]);
        html += "</tr>\n";
    }
    html += "</tbody></table></div>\n";
    for (const auto& note : table.notes) html += "<p class=\"note\">" + html_text(note) + "</p>\n";
    return html;
}

std::string html_list(const std::vector<std::string>& texts) {
    if (texts.empty()) return "";
    std::string html = "<ul>\n";
    for (const auto& text : texts) html += "<li>" + html_text(text) + "</li>\n";
    return html + "</ul>\n";
}

}  // namespace mcdem::report
