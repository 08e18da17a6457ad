// Style sheet and scripts of reports (*.css, *.js in this folder), embedded at build time.
#pragma once
#include <map>
#include <string>

namespace mcdem::inline report {
/// File name -> content.
const std::map<std::string, std::string>& page_parts();
}  // namespace mcdem::report
