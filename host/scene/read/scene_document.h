// The TOML text of a scene and its overrides as a flat list of dotted keys, each with its value and place.
#pragma once
#include <toml++/toml.h>

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "scene/read/problems.h"

namespace mcdem::inline scene {

/// "batch.vary.contact.model" is the variation of "contact.model".
inline constexpr std::string_view vary_prefix = "batch.vary.";

struct Entry {
    std::string key;  ///< without the prefix of a variation
    bool varied = false;
    toml::node* value = nullptr;  ///< owned by the document
    Place place;
    std::string full_name() const { return std::string(varied ? vary_prefix : "") + key; }
};

class SceneDocument {
public:
    /// Throws InputError if the text is not TOML. Invalid overrides are added to `problems`.
    SceneDocument(std::string_view text, std::string source, const std::vector<std::string>& overrides,
                  Problems& problems);
    SceneDocument(const SceneDocument&) = delete;
    SceneDocument& operator=(const SceneDocument&) = delete;

    /// In order of the file, followed by the overrides.
    const std::vector<Entry>& entries() const { return entries_; }
    /// The first entry that sets or varies the key; null if there is none.
    const Entry* find(std::string_view key) const;
    /// Its place; the whole file if there is none.
    Place place_of(std::string_view key) const;
    /// Place of one value of a list.
    Place place_of(const Entry& entry, const toml::node& element) const;
    /// The text as given, or, if overrides or full paths of files change it, equivalent TOML without
    /// comments.
    std::string text() const;

private:
    void parse(std::string_view text);
    void flatten(toml::table& table, const std::string& prefix, std::vector<Entry>& into) const;
    void flatten(toml::array& elements, const std::string& table, std::vector<Entry>& into) const;
    Entry entry_of(std::string key, toml::node& node) const;
    void sort_entries(Problems& problems);
    void apply(const std::string& override_text, Problems& problems);
    void put(const Entry& entry);
    void resolve_files();

    std::string source_;
    std::string text_;
    bool changed_ = false;
    std::deque<toml::table> tables_;  ///< that of the file, then one for each override
    std::vector<Entry> entries_;
};

}  // namespace mcdem::scene
