// Any bytes as a packing, in each format: grains with sound numbers come out or an InputError.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <sstream>

#include "core/errors.h"
#include "scene/foreign_table.h"
#include "scene/read_packing.h"

namespace {

void expect_sound(const mcdem::Packing& packing) {
    if (packing.position.size() != packing.diameter.size()) std::abort();
    for (std::size_t i = 0; i < packing.position.size(); ++i)
        if (!packing.position[i].allFinite() || !(packing.diameter[i] > 0) || !std::isfinite(packing.diameter[i]))
            std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    for (const auto read : {mcdem::read_lammps_packing, mcdem::read_csv_packing}) {
        std::istringstream input(std::string(reinterpret_cast<const char*>(bytes), size));
        try {
            expect_sound(read(input, "packing"));
        } catch (const mcdem::InputError&) {
        }
    }
    try {
        expect_sound(packing_of(mcdem::parse_foreign_table({reinterpret_cast<const char*>(bytes), size}, "packing")));
    } catch (const mcdem::InputError&) {
    }
    return 0;
}
