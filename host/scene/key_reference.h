// The reference of scene keys in scenes/README.md.
#pragma once
#include <string>

namespace mcdem::inline scene {

/// Every key with its type, default and meaning: Markdown, one table for each TOML table.
std::string key_reference();

}  // namespace mcdem::scene
