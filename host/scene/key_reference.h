// The reference of scene keys in scenes/README.md.
#pragma once
#include <string>

namespace mcdem {

/// Every key with what it takes, its default and its meaning: Markdown, one table for each TOML table.
std::string key_reference();

}  // namespace mcdem
