// What the columns of a laboratory's or another program's tables mean: guessed, written as mapping.toml,
// corrected by the user, and read back.
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/names.h"
#include "experiment/experiment_problems.h"
#include "scene/foreign_table.h"

namespace mcdem {

enum class Role { plate, grains, contacts, aside };
template <>
struct Names<Role> {
    static constexpr std::array<std::string_view, 4> list{"plate", "grains", "contacts", "aside"};
};

/// How sure a guess is. An unclear one must be confirmed in the mapping before anything is imported.
enum class Sure { stated, sure, likely, unclear };
template <>
struct Names<Sure> {
    static constexpr std::array<std::string_view, 4> list{"stated", "sure", "likely", "unclear"};
};

struct Guess {
    std::vector<std::string> words;  ///< a word, or columns, see SignedColumn
    Sure sure = Sure::stated;
    std::string why;
    long line = 0;  ///< in the mapping
    const std::string& word() const { return words.front(); }
};

/// A column as a mapping writes it: "-z" where z counts the other way. No column's own name begins so.
struct SignedColumn {
    double sign;
    std::string_view name;
};
inline SignedColumn signed_column(std::string_view word) {
    return word.starts_with('-') ? SignedColumn{-1, word.substr(1)} : SignedColumn{1, word};
}

/// What an entry of a table may be.
struct MappingKey {
    enum class Kind { column, quantity, quantities, word, number };  ///< quantities may have a sign
    std::string_view name;
    Kind kind;
    std::string_view words;  ///< those that a word may be, parted by blanks
    std::string_view meaning;
};

std::span<const MappingKey> mapping_keys(Role role);
const MappingKey* find_mapping_key(Role role, std::string_view name);  ///< null: none of this name

struct MappedTable {
    Role role = Role::aside;
    Sure role_sure = Sure::stated;
    std::string role_why;
    long line = 0;                   ///< in the mapping
    std::vector<std::string> files;  ///< alike, in the order of the frames
    std::vector<std::string> aside;  ///< columns that were seen and are not used
    std::optional<TextForm> form;    ///< of text
    std::string decimal_unclear;     ///< why; empty: it is clear
    std::map<std::string, Guess, std::less<>> entries;
    std::map<std::string, Guess, std::less<>>
        walls;  ///< of contacts: from what the table calls a wall to its name

    const Guess* find(std::string_view key) const {
        const auto found = entries.find(key);
        return found == entries.end() ? nullptr : &found->second;
    }
    bool has(std::string_view key) const { return find(key); }
    /// The entry's word, or `otherwise` where there is none.
    std::string word(std::string_view key, const std::string& otherwise) const {
        const Guess* guess = find(key);
        return guess ? guess->word() : otherwise;
    }
};

struct Mapping {
    std::string file;  ///< where it was read from; empty: guessed
    std::vector<MappedTable> tables;
};

/// A wall of which the direction of each force decides which one it is.
inline constexpr std::string_view by_direction = "by direction";

/// Units and signs that the table's columns need: no mapping may leave them out.
std::vector<std::string_view> must_be_stated(const MappedTable& table);
inline constexpr std::string_view length_words = "m cm mm um", force_words = "N mN uN kN cN daN gf kgf lbf";

double length_factor(std::string_view unit);  ///< metres in a unit
double force_factor(std::string_view unit);   ///< newtons in a unit

/// The mapping as TOML, each guess with how sure it is and why; unclear ones begin with a question mark.
std::string mapping_text(const Mapping& mapping);

/// Throws InputError with every problem; what still has its question mark is one.
Mapping read_mapping(const std::filesystem::path& file);
Mapping parse_mapping(std::string_view text, const std::string& file);

/// The columns of a table that the mapping does not use.
std::vector<std::string> left_aside(const MappedTable& map, const std::vector<std::string>& columns);

/// The lines of a mapping's text that must be confirmed, each as a problem with file, line and what to choose
/// from.
std::vector<std::string> unclear_entries(const std::string& text, const std::string& file);

}  // namespace mcdem
