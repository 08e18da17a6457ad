#include "core/make_folder.h"

#include <system_error>

#include "core/errors.h"

namespace mcdem {

void make_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw RunError(folder.string() + ": cannot be made: " + error.message());
}

}  // namespace mcdem
