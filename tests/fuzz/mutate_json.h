// Changes the structure of a valid JSON document: values, types, names, nesting.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "fuzz/byte_source.h"

namespace mcdem::fuzz {

namespace detail {

inline nlohmann::json some_value(ByteSource& source, const nlohmann::json& before) {
    using nlohmann::json;
    switch (source.below(10)) {
        case 0:
            return nullptr;
        case 1:
            return source.byte() % 2 == 0;
        case 2:
            return source.integer();
        case 3:
            return source.number();
        case 4:
            return std::string(source.below(20), static_cast<char>(' ' + source.byte() % 90));
        case 5:
            return json::array({before, before});
        case 6:
            return json{{"folder", before}};
        case 7:
            return json::array();
        case 8:
            return source.byte() % 2 ? "../../etc" : "/";
        default:
            return json::object();
    }
}

inline void mutate_one(nlohmann::json& root, ByteSource& source) {
    nlohmann::json* at = &root;
    for (int depth = 0;
         depth < 8 && at->is_structured() && !at->empty() && (at == &root || source.byte() % 4); ++depth) {
        auto child = at->begin();
        std::advance(child, static_cast<std::ptrdiff_t>(source.below(at->size())));
        if (source.byte() % 8 == 0) {
            at->erase(child);
            return;
        }
        if (at->is_array() && source.byte() % 16 == 0) {
            at->push_back(*child);
            return;
        }
        at = &*child;
    }
    *at = some_value(source, *at);
}

}  // namespace detail

/// Makes a few changes to `text`, as many as `source` has bytes for.
inline std::string mutate_json(const std::string& text, ByteSource& source) {
    auto root = nlohmann::json::parse(text);
    for (int change = 0; change < 4 && !source.empty(); ++change) detail::mutate_one(root, source);
    return root.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace mcdem::fuzz
