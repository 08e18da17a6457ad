// Reads any bytes as a packing, in each format: valid grains or an InputError.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <string>

#include "core/errors.h"
#include "scene/packing/read_packing.h"

namespace {

void expect_sound(const mcdem::Packing& packing) {
    if (packing.position.size() != packing.diameter.size()) std::abort();
    for (std::size_t i = 0; i < packing.position.size(); ++i)
        if (!packing.position[i].allFinite() || !(packing.diameter[i] > 0) ||
            !std::isfinite(packing.diameter[i]))
            std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(bytes), size);
    const std::function<mcdem::Packing()> readers[] = {
        [&] { return mcdem::read_lammps_packing(text, "packing"); },
        [&] { return mcdem::read_csv_packing(text, "packing"); },
        [&] { return mcdem::read_dump_packing(text, "packing"); },
        [&] { return mcdem::read_yade_packing(text, "packing"); }};
    for (const auto& read : readers) try {
            expect_sound(read());
        } catch (const mcdem::InputError&) {
        }
    return 0;
}
