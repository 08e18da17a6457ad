// The reference of scene keys in scenes/README.md.
#pragma once
#include <string>

namespace mcdem::inline scene {

/// Every key with what it takes, its default and its meaning: Markdown, one table for each TOML table.
std::string key_reference();

}  // namespace mcdem::scene
