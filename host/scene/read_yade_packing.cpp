// Yade's text files from export.text and export.textExt: x y z r, or the columns in the `#format` line.
#include <fmt/format.h>

#include <algorithm>

#include "scene/packing_fields.h"
#include "scene/read_packing.h"

namespace mcdem::inline scene {
namespace {

constexpr std::string_view mark = "format ";

/// The words after a # at the beginning of a line.
std::string_view comment_of(std::string_view line) {
    line = without_blanks(line);
    return line.starts_with('#') ? without_blanks(line.substr(1)) : std::string_view();
}

bool is_row(std::string_view line) {
    line = without_blanks(line);
    return !line.empty() && line.front() != '#';
}

/// Columns in a line `#format x_y_z_r_matId`.
std::vector<std::string> columns_of(std::string_view format) {
    std::vector<std::string> names;
    for (std::size_t first = 0; first < format.size();) {
        const auto end = std::min(format.find('_', first), format.size());
        names.emplace_back(format.substr(first, end - first));
        first = end + 1;
    }
    return names;
}

}  // namespace

bool looks_like_yade(std::string_view text) {
    if (comment_of(text.substr(0, text.find('\n'))).starts_with(mark)) return true;
    TextLines lines(text);
    auto line = lines.next();
    while (line && !is_row(*line)) line = lines.next();
    std::vector<std::string_view> words;
    if (line) split_at_blanks(*line, words);
    return words.size() >= 4 &&
           std::ranges::all_of(words, [](auto word) { return to_number(word).has_value(); });
}

Packing read_yade_packing(std::string_view text, const std::string& source) {
    FileProblems problems(source);
    std::vector<std::string> names{"x", "y", "z", "r"};
    std::optional<GrainRows> grains;
    std::vector<std::string_view> words;
    TextLines lines(text);
    std::size_t width = 0;
    for (auto line = lines.next(); line && !problems.full(); line = lines.next()) {
        const std::string_view comment = comment_of(*line);
        if (!grains && comment.starts_with(mark))
            names = columns_of(without_blanks(comment.substr(mark.size())));
        if (!is_row(*line)) continue;
        split_at_blanks(*line, words);
        if (!grains) {
            width = words.size();
            grains.emplace(GrainColumns::named(names, source), names, problems);
        }
        if (words.size() == width && width >= names.size() - (names.back() == "attrs" ? 1 : 0))
            grains->add(words, lines.number());
        else
            problems.add(lines.number(),
                         fmt::format("must have {} columns, as the first row or the #format line, got {}",
                                     std::max(width, names.size()), words.size()));
    }
    if (!grains) problems.add("must have at least one row with a number in it, got none");
    problems.report();
    return grains->packing();
}

}  // namespace mcdem::scene
