#include "cl/program.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>

#include "cl/held_signals.h"
#include "cl/kernel_sources.h"
#include "core/errors.h"
#include "core/input_file.h"
#include "core/look.h"

namespace mcdem::inline opencl {
namespace {

std::string kernel_source(const std::string& name) {
    if (const char* folder = std::getenv("MCDEM_KERNELS"); folder && *folder) {
        const auto file = std::filesystem::path(folder) / name;
        if (!is_file(file))
            throw InputError(fmt::format(
                "MCDEM_KERNELS: must name the folder of the kernels, got '{}', where {} cannot be "
                "read: give `kernels` of the sources, or unset it for those built in",
                folder, name));
        return read_file(file);
    }
    return embedded_kernel_sources().at(name);
}

/// Expands every `#include "name"` once, with #line so that messages of the compiler name the file.
void append_source(const std::string& name, std::set<std::string>& seen, std::string& text) {
    if (!seen.insert(name).second) return;
    std::istringstream lines(kernel_source(name));
    std::string line;
    const std::string directive = "#include \"";
    text += fmt::format("#line 1 \"{}\"\n", name);
    for (int number = 1; std::getline(lines, line); ++number) {
        if (!line.starts_with(directive)) {
            text += line + "\n";
            continue;
        }
        append_source(line.substr(directive.size(), line.rfind('"') - directive.size()), seen, text);
        text += fmt::format("#line {} \"{}\"\n", number + 1, name);
    }
}

}  // namespace

KernelBuild kernel_build(const Device& device, Precision precision, int slots) {
    KernelBuild build;
    build.precision = precision;
    build.slots = slots;
    build.lanes = device.info().gpu ? 1 : 16;
    build.group = std::min(build.group, device.info().largest_work_group);
    if (const char* lanes = std::getenv("MCDEM_LANES")) {
        build.lanes = std::atoi(lanes);
        if (build.lanes != 1 && build.lanes != 16)
            throw InputError(fmt::format("MCDEM_LANES: must be 1 or 16, got '{}'", lanes));
    }
    if (precision == Precision::double_precision && !device.info().double_precision)
        throw InputError(
            fmt::format("numerics.precision: must be float on {}, which has no double", device.info().name));
    return build;
}

std::string program_text() {
    std::set<std::string> seen;
    std::string text;
    append_source("mcdem.cl", seen, text);
    return text;
}

cl::Program build_program(const Device& device, const KernelBuild& build) {
    // -w: warnings about the device's own headers and vector widths do not help the user.
    const auto options = fmt::format(
        "-w -cl-std=CL1.2 -DMCDEM_DOUBLE={} -DLANES={} -DSLOTS={} -DBLOCK={} "
        "-DLIST_ITEMS={}{}",
        build.precision == Precision::double_precision ? 1 : 0, build.lanes, build.slots, build.block(),
        build.list_items(), build.species > 1 ? fmt::format(" -DSPECIES={}", build.species) : "");
    cl::Program program(device.context(), program_text());
    try {
        const HeldSignals held;
        program.build({device.handle()}, options.c_str());
    } catch (const cl::Error&) {
        throw RunError(fmt::format(
            "the kernels do not compile on {} with {}, or the compiler cannot write its "
            "files (full disk, `ulimit -f`):\n{}",
            device.info().name, options, program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device.handle())));
    }
    return program;
}

}  // namespace mcdem::opencl
