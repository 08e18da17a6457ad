#include "cli/run/checked_device.h"

#include <fmt/format.h>

#include "cl/kernel_cache.h"
#include "cl/program.h"
#include "cli/shell/interrupt.h"
#include "cli/shell/messages.h"
#include "core/atomic_file.h"
#include "core/look.h"
#include "core/make_folder.h"
#include "core/sha256.h"
#include "core/version.h"

namespace mcdem::inline cli {
namespace {

namespace fs = std::filesystem;

/// The file that records a pass; empty if the user has no cache folder.
fs::path record_of(const Device& device, Precision precision) {
    const fs::path cache = user_cache();
    if (cache.empty()) return {};
    const int lanes = kernel_build(device, precision, 16).lanes;
    Sha256 what;
    what.add(fmt::format("{} {} {} {}\n", device.description(), version_text, name(precision), lanes));
    what.add(program_text());
    return cache / "mcdem/devices" / what.hex();
}

}  // namespace

DeviceCheck check_and_record(Device& device, Precision precision) {
    const DeviceCheck check = check_device(device, precision);
    const fs::path record = record_of(device, precision);
    if (!check.passed() || record.empty()) return check;
    try {
        make_folder(record.parent_path());
        replace_file(record, device.description() + ": differs " + check.text() + "\n");
    } catch (const RunError&) {
        // A folder that cannot be written: the next run checks again.
    }
    return check;
}

void check_at_first_use(Device& device, Precision precision) {
    const fs::path record = record_of(device, precision);
    if (!record.empty() && is_there(record)) return;
    const Interrupt interrupt;
    const DeviceCheck check = check_and_record(device, precision);
    if (Interrupt::wanted()) throw Interrupted();
    if (!check.passed())
        throw RunError(fmt::format(
            "{}: computes wrong forces, which differ from the reference {}. Update the driver, remove its "
            "compiled kernels (of PoCL: the folder ~/.cache/pocl), or choose another device by --device; "
            "`mcdem devices --check` compares all of them",
            device.description(), check.text()));
    spdlog::info("first use of {}: differs from the reference {}", device.info().name, check.text());
}

}  // namespace mcdem::cli
