// Text and tables for an HTML page.
#pragma once
#include <string>

#include "report/page/text_table.h"

namespace mcdem::inline report {

/// Escapes a text for use in an element or in a quoted attribute.
std::string html_text(const std::string& text);

/// A <table> with its notes below; empty if it has no rows.
std::string html_table(const TextTable& table);

/// A <ul> of texts; empty if there are none.
std::string html_list(const std::vector<std::string>& texts);

}  // namespace mcdem::report
