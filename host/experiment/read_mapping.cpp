// mapping.toml, as the user has left it.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>

#include "core/errors.h"
#include "core/input_file.h"
#include "experiment/import_mapping.h"

namespace mcdem {
namespace {

namespace fs = std::filesystem;
constexpr std::uintmax_t largest_mapping = 1'000'000;  // bytes
constexpr auto choices = "a text, or a list of texts";

class MappingReader {
public:
    MappingReader(const std::string& file, ExperimentProblems& problems) : file_(file), problems_(problems) {}

    Mapping read(const toml::table& root) {
        Mapping mapping{file_, {}};
        for (const auto& [key, node] : root)
            if (key.str() != "table" || !node.is_array_of_tables())
                wrong(node, fmt::format("{} must be a list of tables, [[table]], got something else",
                                        mcdem::quoted(key.str())));
        if (const auto* tables = root["table"].as_array())
            for (const auto& node : *tables)
                if (node.is_table()) mapping.tables.push_back(read_table(*node.as_table()));
        if (mapping.tables.empty() && problems_.empty())
            problems_.add(file_, "must hold at least one [[table]], got none");
        return mapping;
    }

private:
    void wrong(const toml::node& node, const std::string& what) {
        problems_.add(fmt::format("{}:{}", file_, node.source().begin.line), what);
    }

    /// The words of an entry, as they are; none where it is something else than text.
    std::vector<std::string> words_of(std::string_view key, const toml::node& node) {
        std::vector<std::string> words;
        if (const auto* text = node.as_string()) words.push_back(text->get());
        if (const auto* list = node.as_array())
            for (const auto& element : *list)
                if (const auto* text = element.as_string()) words.push_back(text->get());
        const bool all = node.is_string() || (node.is_array() && words.size() == node.as_array()->size());
        if (!all || words.empty() || std::ranges::any_of(words, &std::string::empty)) {
            wrong(node, fmt::format("{} must be {}, got something else", mcdem::quoted(key), choices));
            return {};
        }
        for (std::string& word : words)
            if (word.front() == '?' && key != "files") {
                wrong(node,
                      fmt::format(
                          "{} must be confirmed, got {}: put in what is right, without the question mark",
                          key, mcdem::quoted(word)));
                word.erase(0, 1);
            }
        return words;
    }

    std::string word_of(const toml::table& table, std::string_view key, const std::string& otherwise) {
        const auto* node = table.get(key);
        if (!node) return otherwise;
        const auto words = words_of(key, *node);
        if (words.size() > 1) wrong(*node, fmt::format("{} must be one text, got {}", key, words.size()));
        return words.empty() ? otherwise : words.front();
    }

    void read_form(const toml::table& node, MappedTable& table) {
        if (!node.contains("separator") && !node.contains("decimal")) return;
        const std::string separator = word_of(node, "separator", ","),
                          decimal = word_of(node, "decimal", ".");
        TextForm form;
        if (separator == "tab")
            form.separator = '\t';
        else if (separator == "blanks")
            form.separator = ' ';
        else if (separator == "," || separator == ";")
            form.separator = separator[0];
        else
            wrong(*node.get("separator"),
                  fmt::format("separator must be one of \",\", \";\", tab, blanks, got {}",
                              mcdem::quoted(separator)));
        if (decimal == "." || decimal == ",")
            form.decimal = decimal[0];
        else
            wrong(*node.get("decimal"),
                  fmt::format("decimal must be \".\" or \",\", got {}", mcdem::quoted(decimal)));
        table.form = form;
    }

    void read_entry(const MappingKey& key, const toml::node& node, MappedTable& table) {
        Guess guess{words_of(key.name, node), Sure::stated, "", static_cast<long>(node.source().begin.line)};
        if (guess.words.empty()) return;
        if (guess.words.size() > 1 && key.kind != MappingKey::Kind::quantities)
            return wrong(node, fmt::format("{} must be one text, got {}", key.name, guess.words.size()));
        const bool is_quantity =
            key.kind == MappingKey::Kind::quantity || key.kind == MappingKey::Kind::quantities;
        if (is_quantity && std::ranges::find(guess.words, "-") != guess.words.end())
            return wrong(node, fmt::format("{} must be a column, got a sign only", key.name));
        if (key.kind == MappingKey::Kind::column && guess.word().starts_with('-'))
            return wrong(node, fmt::format("{} must be a column without a sign, got {}", key.name,
                                           mcdem::quoted(guess.word())));
        if (key.kind == MappingKey::Kind::number && !to_number(guess.word()))
            return wrong(node, fmt::format("{} must be a number in quotes, got {}", key.name,
                                           mcdem::quoted(guess.word())));
        if (key.kind == MappingKey::Kind::word) {
            const std::string allowed = fmt::format(" {} ", key.words);
            if (guess.word().find(' ') != std::string::npos ||
                allowed.find(fmt::format(" {} ", guess.word())) == std::string::npos)
                return wrong(node, fmt::format("{} must be one of {}, got {}", key.name, key.words,
                                               mcdem::quoted(guess.word())));
        }
        table.entries[std::string(key.name)] = std::move(guess);
    }

    void read_walls(const toml::node& node, MappedTable& table) {
        if (!node.is_table()) return wrong(node, "walls must be a table, [table.walls], got something else");
        for (const auto& [word, value] : *node.as_table()) {
            Guess guess{words_of(word.str(), value), Sure::stated, "",
                        static_cast<long>(value.source().begin.line)};
            if (guess.words.size() != 1) continue;
            if (!parse<Wall>(guess.word()) && guess.word() != by_direction)
                wrong(value, fmt::format("a wall must be one of {}, {}, got {}", all_names<Wall>(),
                                         by_direction, mcdem::quoted(guess.word())));
            else
                table.walls[std::string(word.str())] = std::move(guess);
        }
    }

    MappedTable read_table(const toml::table& node) {
        MappedTable table;
        table.line = static_cast<long>(node.source().begin.line);
        const std::string role = word_of(node, "role", "");
        if (const auto known = parse<Role>(role))
            table.role = *known;
        else
            wrong(node.contains("role") ? *node.get("role") : node,
                  fmt::format("role must be one of {}, got {}", all_names<Role>(), mcdem::quoted(role)));
        if (const auto* files = node.get("files")) table.files = words_of("files", *files);
        if (table.files.empty()) wrong(node, "files must name at least one file, got none");
        read_form(node, table);
        for (const auto& [word, value] : node) {
            const std::string_view key = word.str();
            if (key == "role" || key == "files" || key == "separator" || key == "decimal") continue;
            const MappingKey* found = find_mapping_key(table.role, key);
            if (key == "walls" && table.role == Role::contacts)
                read_walls(value, table);
            else if (found)
                read_entry(*found, value, table);
            else if (table.role != Role::aside)
                wrong(value,
                      fmt::format(
                          "{} must be a key of a table of {}, got another: remove it, or choose from {}",
                          mcdem::quoted(key), name(table.role), key_list(mapping_keys(table.role))));
        }
        for (const std::string_view key : must_be_stated(table))
            if (!node.contains(key)) wrong(node, needed_text(table.role, key));
        return table;
    }

    static std::string needed_text(Role role, std::string_view key) {
        const MappingKey* found = find_mapping_key(role, key);
        return fmt::format("{} must be stated, one of {}{}{}, got none", key, found->words,
                           found->meaning.empty() ? "" : ": ", found->meaning);
    }

    static std::string key_list(std::span<const MappingKey> keys) {
        std::string text;
        for (const MappingKey& key : keys) text += (text.empty() ? "" : ", ") + std::string(key.name);
        return text;
    }

    std::string file_;
    ExperimentProblems& problems_;
};

}  // namespace

Mapping parse_mapping(std::string_view text, const std::string& file) {
    ExperimentProblems problems;
    Mapping mapping;
    try {
        mapping = MappingReader(file, problems).read(toml::parse(text, file));
    } catch (const toml::parse_error& error) {
        problems.add(fmt::format("{}:{}", file, error.source().begin.line),
                     fmt::format("must be TOML, got: {}", error.description()));
    }
    problems.report();
    return mapping;
}

Mapping read_mapping(const fs::path& file) {
    std::error_code error;
    if (!fs::is_regular_file(file, error) || fs::file_size(file, error) > largest_mapping || error)
        throw InputError(fmt::format("{}: must be a mapping of at most 1 MB, got {}", file.string(),
                                     fs::exists(file, error) ? "something else" : "no such file"));
    return parse_mapping(read_file(file), file.string());
}

}  // namespace mcdem
