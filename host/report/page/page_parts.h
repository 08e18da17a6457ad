// The style sheet and the scripts of reports (*.css, *.js of this folder), put into the program at build
// time.
#pragma once
#include <map>
#include <string>

namespace mcdem::inline report {
/// File name -> content.
const std::map<std::string, std::string>& page_parts();
}  // namespace mcdem::report
