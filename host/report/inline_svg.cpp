#include <array>
#include <cctype>
#include <vector>

#include "core/errors.h"
#include "report/html.h"

namespace mcdem {
namespace {

struct Attribute {
    std::string name, value;
};

/// gnuplot's colours that must follow the page, as it writes them less blanks.
struct Ink {
    const char* written;
    const char* meant;
};
constexpr std::array<Ink, 5> inks{{{"black", "var(--ink)"},
                                   {"rgb(0,0,0)", "var(--ink)"},
                                   {"rgb(34,34,34)", "var(--ink)"},
                                   {"rgb(68,68,68)", "var(--axis)"},
                                   {"rgb(221,221,221)", "var(--grid)"}}};

bool is_blank(char c) { return std::isspace(static_cast<unsigned char>(c)); }

/// The attributes of the tag's text between < and >, after its name.
std::vector<Attribute> attributes_of(const std::string& tag, std::size_t from) {
    std::vector<Attribute> attributes;
    while (true) {
        while (from < tag.size() && (is_blank(tag[from]) || tag[from] == '/')) ++from;
        const auto equals = tag.find('=', from);
        if (equals == std::string::npos) return attributes;
        auto name = tag.substr(from, equals - from);
        while (!name.empty() && is_blank(name.back())) name.pop_back();
        const auto open = tag.find_first_of("'\"", equals);
        const auto close = open == std::string::npos ? open : tag.find(tag[open], open + 1);
        if (close == std::string::npos) throw RunError("a picture's SVG cannot be read: <" + tag + ">");
        attributes.push_back({name, tag.substr(open + 1, close - open - 1)});
        from = close + 1;
    }
}

/// An attribute as it is in a page; empty where it falls away.
std::string adapted(const Attribute& attribute, const std::string& tag, const std::string& prefix) {
    auto [name, value] = attribute;
    if (name.starts_with("xmlns") || name == "font-family") return "";
    if (name == "xlink:href") name = "href";
    if (name == "id") value = prefix + value;
    if (value.starts_with("#") && name == "href") value = "#" + prefix + value.substr(1);
    if (value.starts_with("url(#")) value = "url(#" + prefix + value.substr(5);
    if (tag == "rect" && name == "fill" && value == "#ffffff") value = "none";  // the background
    auto colour = value;
    std::erase(colour, ' ');
    for (const auto& [written, meant] : inks)
        if (colour == written) value = meant;
    const char quote = value.find('"') == std::string::npos ? '"' : '\'';
    return " " + name + "=" + quote + value + quote;
}

/// The end of the tag that starts at `start`: the first > out of quotes.
std::size_t end_of_tag(const std::string& svg, std::size_t start) {
    char quote = 0;
    for (std::size_t i = start; i < svg.size(); ++i) {
        if (quote) {
            if (svg[i] == quote) quote = 0;
        } else if (svg[i] == '\'' || svg[i] == '"') {
            quote = svg[i];
        } else if (svg[i] == '>') {
            return i;
        }
    }
    throw RunError("a picture's SVG cannot be read: it ends within a tag");
}

std::string adapted_tag(const std::string& tag, const std::string& prefix, const std::string& about) {
    const auto name = tag.substr(0, tag.find_first_of(" \t\r\n/", 1));
    std::string text = "<" + name;
    if (name == "svg") text += " role=\"img\" aria-label=\"" + html_text(about) + "\"";
    for (const auto& attribute : attributes_of(tag, name.size())) text += adapted(attribute, name, prefix);
    return text + (tag.ends_with('/') ? "/>" : ">");
}

/// Elements that only say where the file comes from, or would show up as a tooltip.
bool left_out(const std::string& svg, std::size_t start, std::size_t& end) {
    for (const std::string name : {"title", "desc"}) {
        if (svg.compare(start, name.size() + 2, "<" + name + ">") != 0) continue;
        const auto closing = "</" + name + ">";
        end = svg.find(closing, start);
        if (end == std::string::npos) return false;
        end += closing.size();
        return true;
    }
    return false;
}

}  // namespace

std::string inline_svg(const std::string& svg, const std::string& name, const std::string& about) {
    auto at = svg.find("<svg");
    if (at == std::string::npos) throw RunError("a picture's SVG cannot be read: it has no <svg>");
    std::string page;
    while (at < svg.size()) {
        const auto start = svg.find('<', at);
        page += svg.substr(at, start - at);
        if (start == std::string::npos) break;
        if (left_out(svg, start, at)) continue;
        const auto end = end_of_tag(svg, start);
        const auto tag = svg.substr(start + 1, end - start - 1);
        page += tag.starts_with('/') ? "<" + tag + ">" : adapted_tag(tag, name + "-", about);
        at = end + 1;
    }
    return page;
}

}  // namespace mcdem
