// Changes the structure of the manifests that the program reads back. They must be read or give an
// InputError.
#include "core/errors.h"
#include "ensemble/parts/manifest.h"
#include "fuzz/mutate_json.h"
#include "fuzz/scratch_folder.h"

namespace {

using namespace mcdem;
using fuzz::ByteSource;
using fuzz::scratch_folder;

constexpr auto manifest = R"({"program": "0.1", "number of replicas": "4", "replicas of a part": "2"})";

void try_manifest(ByteSource& source) {
    const auto file = scratch_folder() / "manifest.json";
    fuzz::write_bytes(file, fuzz::mutate_json(manifest, source));
    try {
        read_manifest(file);
        keep_manifest(file, {{"program", "0.1"}, {"replicas of a part", "1"}}, "replicas of a part");
    } catch (const InputError&) {
    } catch (const std::bad_alloc&) {
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    ByteSource source(bytes, size);
    try_manifest(source);
    return 0;
}
