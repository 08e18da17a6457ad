// Functions that read pages for the tests.
#pragma once
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>

namespace mcdem {

inline std::string text_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Pages are too long for the message of a failed test.
inline bool contains(const std::string& page, const std::string& part) {
    return page.find(part) != std::string::npos;
}

/// The data of a page's charts and packings.
inline nlohmann::json content_of(const std::string& page) {
    const std::string begin = "<script type=\"application/json\" id=\"content\">";
    const auto at = page.find(begin) + begin.size();
    return nlohmann::json::parse(page.substr(at, page.find("</script>", at) - at));
}

/// The page without scripts, style sheet and plotting library.
inline std::string markup_of(const std::string& page) {
    std::string markup = page;
    for (const std::string tag : {"script", "style"})
        for (auto at = markup.find("<" + tag); at != std::string::npos; at = markup.find("<" + tag, at + 1)) {
            const auto open = markup.find('>', at) + 1;
            markup.erase(open, markup.find("</" + tag + ">", open) - open);
        }
    return markup;
}

inline std::multiset<std::string> all_matches(const std::string& text, const std::string& pattern) {
    const std::regex regex(pattern);
    std::multiset<std::string> found;
    for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match)
        found.insert((*match)[1]);
    return found;
}

/// Checks with Python's HTML parser that every tag is closed in the right order.
inline bool well_formed(const std::string& page, const std::filesystem::path& folder) {
    std::ofstream(folder / "page.html") << page;
    std::ofstream(folder / "check.py") << R"(
import html.parser, sys
class Tags(html.parser.HTMLParser):
    open = []
    def handle_starttag(self, tag, attributes):
        if tag not in ("meta", "img", "input", "br"):
            self.open.append(tag)
    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            sys.exit(1)
tags = Tags()
tags.feed(open(sys.argv[1], encoding="utf-8", errors="replace").read())
tags.close()
sys.exit(1 if tags.open else 0)
)";
    const auto command =
        "python3 '" + (folder / "check.py").string() + "' '" + (folder / "page.html").string() + "'";
    const bool balanced = std::system(command.c_str()) == 0;
    for (const char* name : {"check.py", "page.html"}) std::filesystem::remove(folder / name);
    return balanced;
}

}  // namespace mcdem
