#include "scene/packing/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>

namespace mcdem::inline scene {
namespace {

/// Why the text is not read as a table; empty if it is.
std::string failure_of(std::string_view text) {
    if (text.find('\0') != text.npos) return "holds zero bytes and is no table: save it as text in UTF-8";
    TextLines lines(text);
    while (const auto line = lines.next())
        if (line->size() >= std::size_t{1} << 24)
            return fmt::format("line {} has more than 16 million characters: is this a table?",
                               lines.number());
    return {};
}

void split(std::string_view line, std::vector<std::string_view>& words) {
    words.clear();
    for (std::size_t first = 0; first != std::string_view::npos;) {
        const std::size_t comma = line.find(',', first);
        std::string_view word =
            without_blanks(line.substr(first, comma == std::string_view::npos ? comma : comma - first));
        if (word.size() > 1 && word.front() == '"' && word.back() == '"')  // as R and spreadsheets write text
            word = without_blanks(word.substr(1, word.size() - 2));
        words.push_back(word);
        first = comma == std::string_view::npos ? comma : comma + 1;
    }
}

}  // namespace

Table::Table(std::string name, std::string_view text, const std::vector<std::string>& columns,
             FileProblems& problems, const std::vector<std::string>& optional)
    : name_(std::move(name)), columns_(columns), needed_(columns.size()), problems_(problems) {
    columns_.insert(columns_.end(), optional.begin(), optional.end());
    words_.resize(columns_.size());
    if (const std::string failure = failure_of(text); !failure.empty()) {
        problems_.add(name_, failure);
        return;
    }
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    lines_.emplace(text);
    read_header();
}

std::optional<std::string_view> Table::next_line() {
    while (const auto line = lines_->next()) {
        const std::string_view text = without_blanks(*line);
        if (!text.empty() && text.front() != '#') return text;
    }
    return std::nullopt;
}

void Table::read_header() {
    const auto header = next_line();
    std::vector<std::string_view> names;
    if (header) split(*header, names);
    const long problems_before = problems_.count();
    if (!header)
        problems_.add(name_, fmt::format("is empty: it must begin with the header {}",
                                         fmt::join(std::span(columns_).first(needed_), ",")));
    line_ = lines_->number();
    if (header && names.size() == 1 && header->find_first_of(";\t") != std::string_view::npos) {
        problem("columns must be separated by commas: export the table with commas, and decimal points");
        names.clear();
    }
    for (std::size_t c = 0; c < columns_.size() && !names.empty(); ++c) {
        const auto times = std::ranges::count(names, columns_[c]);
        if (times != 1 && (c < needed_ || times != 0))
            problem(fmt::format("the header must name {} once, got it {} times: the columns are {}",
                                columns_[c], times, fmt::join(columns_, ",")));
    }
    for (std::string_view name : names) {
        const auto found = std::ranges::find(columns_, name);
        column_of_word_.push_back(found == columns_.end() ? -1 : static_cast<int>(found - columns_.begin()));
        if (found == columns_.end() && !name.empty()) others_.emplace_back(name);
    }
    if (problems_.count() > problems_before) lines_.reset();
}

bool Table::has(std::size_t column) const {
    return std::ranges::find(column_of_word_, static_cast<int>(column)) != column_of_word_.end();
}

bool Table::next() {
    std::vector<std::string_view> words;
    while (lines_) {
        const auto line = next_line();
        if (!line) {
            if (rows_ == 0)
                problems_.add(name_, "must have at least one row, got none: add rows, or leave the file out");
            lines_.reset();
            return false;
        }
        line_ = lines_->number();
        ++rows_;
        split(*line, words);
        if (words.size() == column_of_word_.size()) {
            for (std::size_t i = 0; i < words.size(); ++i)
                if (column_of_word_[i] >= 0) words_[column_of_word_[i]] = words[i];
            return true;
        }
        problem(
            fmt::format("must have {} columns as the header, got {}", column_of_word_.size(), words.size()));
    }
    return false;
}

std::optional<double> Table::number(std::size_t column) {
    const auto value = to_number(words_[column]);
    if (!value)
        problem(fmt::format("{} must be a finite number, got {}: correct it, or leave the row out",
                            columns_[column], quoted(words_[column])));
    return value;
}

std::optional<long> Table::whole_number(std::size_t column, long least) {
    const auto value = to_whole_number(words_[column]);
    if (value && *value >= least && *value <= 2'000'000'000) return value;
    problem(fmt::format("{} must be a whole number from {} on, got {}", columns_[column], least,
                        quoted(words_[column])));
    return std::nullopt;
}

void Table::problem(const std::string& what) { problems_.add(fmt::format("{}:{}", name_, line_), what); }

}  // namespace mcdem::scene
