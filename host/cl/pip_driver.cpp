#include "cl/pip_driver.h"

#include <dlfcn.h>
#include <link.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "core/look.h"

namespace mcdem::inline opencl {
namespace {

namespace fs = std::filesystem;

/// The file that contains this function: the program, or the Python module.
fs::path this_file() {
    Dl_info info{};
    void* map = nullptr;
    if (::dladdr1(reinterpret_cast<void*>(&this_file), &info, &map, RTLD_DL_LINKMAP) == 0) return {};
    const auto* const loaded = static_cast<const link_map*>(map);
    std::error_code error;
    return loaded->l_name[0] == '\0' ? fs::read_symlink("/proc/self/exe", error)
                                     : fs::canonical(loaded->l_name, error);
}

/// The folder of Python packages in which pip has installed mcdem: mcdem/bin/mcdem and mcdem/_engine...so.
fs::path packages_folder() {
    fs::path folder = this_file().parent_path();
    if (folder.filename() == "bin") folder = folder.parent_path();
    return folder.filename() == "mcdem" ? folder.parent_path() : fs::path();
}

}  // namespace

std::vector<cl::Platform> pip_platforms() {
    const fs::path packages = packages_folder(), drivers = packages / "pyopencl/.libs";
    if (packages.empty() || !is_folder(drivers)) return {};
    fs::path library;
    for (const fs::path& file : entries_of(drivers))
        if (file.filename().string().starts_with("libpocl")) library = file;
    void* const driver = ::dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library.empty() || !driver) return {};
    // OpenCL's own type of this function is deprecated.
    const auto address_of =
        reinterpret_cast<void* (*)(const char*)>(::dlsym(driver, "clGetExtensionFunctionAddress"));
    const auto get_platforms =
        address_of ? reinterpret_cast<decltype(&clGetPlatformIDs)>(address_of("clIcdGetPlatformIDsKHR"))
                   : nullptr;
    cl_uint count = 0;
    if (!get_platforms || get_platforms(0, nullptr, &count) != CL_SUCCESS) return {};
    std::vector<cl_platform_id> ids(count);
    if (get_platforms(count, ids.data(), nullptr) != CL_SUCCESS) return {};
    if (const fs::path linker = packages / "mcdem/linker"; is_folder(linker)) {
        const char* path = std::getenv("PATH");
        ::setenv("PATH", (linker.string() + (path ? std::string(":") + path : "")).c_str(), 1);
    }
    return {ids.begin(), ids.end()};
}

}  // namespace mcdem::opencl
