#include "report/page/page.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "core/errors.h"
#include "core/input_file.h"
#include "core/look.h"
#include "core/output_file.h"
#include "core/replaced.h"
#include "core/sha256.h"
#include "report/page/labels.h"
#include "report/page/page_parts.h"

namespace mcdem::inline report {
namespace {

/// Text for HTML, escaped, on one line.
std::string html_text(const std::string& text) {
    return replaced(one_line(text),
                    {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}});
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

std::string base64(std::string_view bytes) {
    std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');  // including the library's terminating zero
    const int length =
        EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                        reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<int>(bytes.size()));
    text.resize(static_cast<std::size_t>(length));
    return text;
}

/// The hash of a script for the page's content security policy.
std::string script_hash(const std::string& script) {
    const auto hex = Sha256().add(script).hex();
    std::string bytes;
    for (std::size_t i = 0; i < hex.size(); i += 2)
        bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
    return "'sha256-" + base64(bytes) + "'";
}

/// JSON in which nothing can end the enclosing element.
std::string json_for_page(const Json& json) {
    return replaced(json.dump(-1, ' ', false, Json::error_handler_t::replace),
                    {{'<', "\\u003c"}, {'>', "\\u003e"}, {'&', "\\u0026"}});
}

/// Content security policy. Scripts: only the page's own and the one that it unpacks (plotly.js, which
/// creates functions from text). Images: only those created by the page. All other content and all network
/// access is refused.
std::string policy(const std::string& script) {
    return "default-src 'none'; script-src " + script_hash(script) +
           " 'unsafe-eval'; style-src 'unsafe-inline'; img-src data: blob:";
}

std::string page_script() {
    std::string script;
    for (const char* name : {"page_theme.js", "page_charts.js", "page_packing.js", "page.js"})
        script += page_parts().at(name);
    return "'use strict';\n" + script;
}

std::string head(const std::string& title, const std::string& script) {
    return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
           "<meta name=\"generator\" content=\"mcdem\">\n"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
           "<meta http-equiv=\"Content-Security-Policy\" content=\"" +
           policy(script) + "\">\n<title>" + html_text(title) + "</title>\n<style>\n" +
           page_parts().at("page.css") + "</style>\n</head>\n";
}

namespace fs = std::filesystem;

constexpr const char* file_name = "plotly.js.gz";

/// Folder of this code: of the program, or of the Python module.
fs::path own_folder() {
    std::error_code unknown;
    Dl_info info{};
    if (dladdr(reinterpret_cast<void*>(&page_script), &info) && info.dli_fname &&
        fs::path(info.dli_fname).extension() == ".so")
        return fs::weakly_canonical(info.dli_fname, unknown).parent_path().parent_path();
    return fs::read_symlink("/proc/self/exe", unknown).parent_path();
}

/// Only $MCDEM_SHARE if it is set, so that a wrong value is noticed.
std::vector<fs::path> folders() {
    if (const char* chosen = std::getenv("MCDEM_SHARE")) return {chosen};
    const auto own = own_folder();
    if (own.empty()) return {MCDEM_INSTALLED_SHARE};  // no /proc; never the current folder
    return {own / "share/mcdem", own.parent_path() / "share/mcdem", MCDEM_INSTALLED_SHARE};
}

}  // namespace

void Page::lead(const std::string& kicker, const std::string& heading, const std::string& sentence) {
    body_ += "<header><p class=\"kicker\">" + html_text(kicker) + "</p>\n<h1>" + html_text(heading) +
             "</h1>\n<p class=\"lead\">" + html_text(sentence) + "</p></header>\n";
}

void Page::section(const std::string& heading) { body_ += "<h2>" + html_text(heading) + "</h2>\n"; }

void Page::subheading(const std::string& text) { body_ += "<h3>" + html_text(text) + "</h3>\n"; }

void Page::paragraph(const std::string& text) { body_ += "<p>" + html_text(text) + "</p>\n"; }

void Page::table(const std::string& heading, const TextTable& table) {
    if (table.rows.empty()) return;
    if (!heading.empty()) subheading(heading);
    body_ += html_table(table);
}

void Page::list(const std::vector<std::string>& texts) { body_ += html_list(texts); }

void Page::definitions(const std::vector<std::pair<std::string, std::string>>& lines) {
    body_ += "<dl>\n";
    for (const auto& [about, says] : lines)
        body_ += "<dt>" + html_text(about) + "</dt><dd>" + html_text(says) + "</dd>\n";
    body_ += "</dl>\n";
}

void Page::folded(const std::string& heading, const std::string& text) {
    std::string lines, line;
    for (const char c : text + "\n") {
        if (c != '\n') {
            line += c;
            continue;
        }
        lines += html_text(line) + "\n";
        line.clear();
    }
    body_ += "<details><summary>" + html_text(heading) + "</summary><pre>" + lines + "</pre></details>\n";
}

std::string Page::new_id(const std::string& name) {
    const auto taken = std::ranges::count(ids_, name);
    ids_.push_back(name);
    return taken == 0 ? name : fmt::format("{}_{}", name, taken + 1);
}

void Page::chart(const Chart& chart) {
    const auto id = new_id(chart.name);
    charts_.push_back({{"id", id},
                       {"kind", chart.name},
                       {"values", chart.values},
                       {"log", chart.log_axes},
                       {"height", chart.height}});
    body_ += "<figure><div class=\"bar\"><h3>" + html_text(chart.title) + "</h3>";
    if (!chart.log_axes.empty())
        body_ += "<button type=\"button\" data-log=\"" + id + "\" aria-pressed=\"false\">log axes</button>";
    body_ += "<button type=\"button\" data-svg=\"" + id + "\">SVG</button>";
    body_ += fmt::format(
        "</div>\n<div class=\"wide\"><div class=\"chart\" id=\"{}\" "
        "style=\"height:{}px;min-width:{}px\"></div></div>\n",
        id, chart.height, chart.min_width);
    body_ += "<figcaption>" + html_text(chart.caption) + "</figcaption></figure>\n";
}

void Page::packing(const Json& view, const std::string& caption) {
    const auto id = new_id("packing");
    packings_.push_back({{"id", id}, {"view", view}});
    body_ +=
        "<figure class=\"packing\" data-packing=\"" + id +
        "\"><div class=\"bar\"><h3>The packing</h3>"
        "<label>of <select class=\"setting\"></select></label>"
        "<label>showing <select class=\"what\"><option value=\"both\">force chains and small grains</option>"
        "<option value=\"grains\">grains</option><option value=\"chains\">force chains</option></select>"
        "</label></div>\n<div class=\"chart\" id=\"" +
        id +
        "\"></div>\n"
        "<div class=\"bar\"><button type=\"button\" class=\"play\">play</button>"
        "<input type=\"range\" min=\"0\" value=\"0\" aria-label=\"scan\"><output></output></div>\n"
        "<figcaption>" +
        html_text(caption) + "</figcaption></figure>\n";
}

std::string Page::html(const std::string& packed_library) const {
    const auto script = page_script();
    return head(title_, script) +
           "<body>\n<button type=\"button\" id=\"theme\">dark</button>\n"
           "<p id=\"trouble\" hidden></p>\n<main>\n" +
           body_ + "</main>\n<script type=\"application/json\" id=\"content\">" +
           json_for_page({{"charts", charts_}, {"packings", packings_}}) +
           "</script>\n<script type=\"text/plain\" id=\"library\">" + base64(packed_library) +
           "</script>\n<script>" + script + "</script>\n</body>\n</html>\n";
}

void write_page(const Page& page, const std::filesystem::path& file) {
    replace_own(file, FileKind::page, page.html(packed_plotting_library()));
}

std::string packed_plotting_library() {
    std::string looked;
    for (const auto& folder : folders()) {
        const std::string bytes = is_file(folder / file_name) ? read_file(folder / file_name) : "";
        if (bytes.starts_with("\x1f\x8b")) return bytes;  // magic number of gzip
        looked += (looked.empty() ? "" : ", ") + folder.string();
    }
    throw RunError(
        std::string("the plotting library of reports, ") + file_name + ", is in none of " + looked +
        ": install python3-plotly, then build and install mcdem again, or let MCDEM_SHARE name the "
        "folder that holds it");
}

}  // namespace mcdem::report
