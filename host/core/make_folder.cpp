#include "core/make_folder.h"

#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "core/errors.h"
#include "core/look.h"

namespace mcdem::inline core {

void make_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error && look_at_itself(folder) == At::link && !is_there(folder))
        throw RunError(folder.string() + ": must be a folder, is a link to nothing that is there: remove it");
    if (error) throw RunError(folder.string() + ": cannot be made: " + error.message());
    expect_writable(folder);
}

void expect_writable(const std::filesystem::path& folder) {
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        throw RunError(folder.string() + ": cannot be written to: " + std::generic_category().message(errno));
}

}  // namespace mcdem::core
