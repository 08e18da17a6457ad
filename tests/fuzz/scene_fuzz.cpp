// Reads any bytes as a scene: replicas or an InputError.
#include <cstdint>

#include "core/errors.h"
#include "scene/read/read_scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    try {
        mcdem::parse_scene({reinterpret_cast<const char*>(bytes), size}, "scene.toml");
    } catch (const mcdem::InputError&) {
    }
    return 0;
}
