// A mapping as TOML that a user reads and corrects.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <sstream>

#include "experiment/import_mapping.h"
#include "scene/text_lines.h"

namespace mcdem {
namespace {

constexpr auto introduction =
    R"(# What the tables of an experiment mean, for `mcdem experiment import --mapping`. Every entry says how sure it is and why.
# An entry that begins with a question mark is not safe: put in what is right, without the question mark, and import
# again with --mapping. Columns go by their names, or as "column 3"; where several are listed they are added up.
)";

constexpr std::string_view unclear_mark = "  # unclear: ";

/// The text in TOML's quotes, whatever it holds.
std::string quoted_toml(const std::string& text) {
    std::ostringstream out;
    out << toml::toml_formatter(toml::array{text}, toml::format_flags::none);
    const std::string list = out.str();  // [ "text" ]
    const auto first = list.find_first_of("\"'");
    return list.substr(first, list.find_last_of("\"'") - first + 1);
}

std::string one_line(std::string text) {
    std::ranges::replace_if(
        text, [](unsigned char c) { return c < 32 || c == 127; }, ' ');
    return text;
}

std::string value_text(const Guess& guess) {
    const std::string mark = guess.sure == Sure::unclear ? "?" : "";
    if (guess.words.size() == 1) return quoted_toml(mark + guess.word());
    std::string text = "[";
    for (const std::string& word : guess.words)
        text += (&word == &guess.words.front() ? quoted_toml(mark + word) : ", " + quoted_toml(word));
    return text + "]";
}

std::string line_text(const std::string& key, const Guess& guess, const std::string& meaning) {
    std::string text = fmt::format("{} = {}", key, value_text(guess));
    const std::string why = one_line(guess.why);
    if (guess.sure != Sure::stated) text += fmt::format("  # {}: {}", name(guess.sure), why);
    if (guess.sure == Sure::unclear && !meaning.empty()) text += fmt::format(" ({})", meaning);
    return text + "\n";
}

std::string meaning_of(const MappingKey& key) {
    std::string words(key.words);
    std::ranges::replace(words, ' ', ',');
    if (words.empty()) return std::string(key.meaning);
    std::string text = "one of ";
    for (const char c : words) text += c == ',' ? std::string(", ") : std::string(1, c);
    return text + (key.meaning.empty() ? "" : "; " + std::string(key.meaning));
}

std::string separator_word(char separator) {
    return separator == '\t' ? "tab" : separator == ' ' ? "blanks" : std::string(1, separator);
}

std::string table_text(const MappedTable& table) {
    std::string text = "\n[[table]]\n";
    const Guess role{{std::string(name(table.role))}, table.role_sure, table.role_why};
    text += line_text("role", role, "one of plate, grains, contacts, aside");
    text += "files = [";
    for (const std::string& file : table.files)
        text += (&file == &table.files.front() ? "" : ", ") + quoted_toml(file);
    text += "]\n";
    if (table.form) {
        const Sure sure = table.decimal_unclear.empty() ? Sure::stated : Sure::unclear;
        text += fmt::format("separator = \"{}\"\n", separator_word(table.form->separator));
        text += line_text("decimal", {{std::string(1, table.form->decimal)}, sure, table.decimal_unclear},
                          "a comma or a point");
    }
    if (!table.aside.empty())
        text += fmt::format("# columns left aside: {}\n",
                            one_line(fmt::format("{}", fmt::join(table.aside, ", "))));
    for (const MappingKey& key : mapping_keys(table.role)) {
        if (const Guess* guess = table.find(key.name))
            text += line_text(std::string(key.name), *guess, meaning_of(key));
        else
            text += fmt::format("# {} =  # {}\n", key.name, meaning_of(key));
    }
    if (table.walls.empty()) return text;
    text += "[table.walls]  # what the table calls a wall, and which it is\n";
    for (const auto& [word, guess] : table.walls)
        text += line_text(quoted_toml(word), guess, all_names<Wall>() + ", " + std::string(by_direction));
    return text;
}

}  // namespace

std::string mapping_text(const Mapping& mapping) {
    std::string text = introduction;
    for (const MappedTable& table : mapping.tables) text += table_text(table);
    return text;
}

std::vector<std::string> unclear_entries(const std::string& text, const std::string& file) {
    std::vector<std::string> problems;
    TextLines lines(text);
    while (const auto line = lines.next()) {
        const auto equals = line->find(" = "), comment = line->rfind(unclear_mark);
        if (line->starts_with('#') || equals == line->npos || comment == line->npos) continue;
        const auto value = line->substr(equals + 3, comment - equals - 3);
        problems.push_back(fmt::format("{}:{}: {} must be confirmed, got {}: {}", file, lines.number(),
                                       line->substr(0, equals), value,
                                       line->substr(comment + unclear_mark.size())));
    }
    return problems;
}

}  // namespace mcdem
