// Changes the structure of the manifests and observations that the program reads back. They must be read or
// give an InputError. The first byte selects one of both, the others the changes.
#include "core/errors.h"
#include "ensemble/diagnosis/observation_store.h"
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

/// Observations of any length and content, with or without digest: the stored values are returned, or
/// nothing.
void try_observation(ByteSource& source) {
    const ObservationStore store(scratch_folder());
    Eigen::VectorXd kept(static_cast<Eigen::Index>(source.below(50)));
    for (double& value : kept) value = source.number();
    store.keep("one", kept);
    const auto file = scratch_folder() / "one.obs";
    std::string bytes = fuzz::bytes_of(file);
    const bool changed = source.byte() % 2;
    if (changed) bytes.resize(source.below(2 * bytes.size()), 'x');
    const bool same = bytes == fuzz::bytes_of(file);
    fuzz::write_bytes(file, bytes);
    const auto found = store.find("one");
    if (found.has_value() != same || (found && found->size() != kept.size())) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    ByteSource source(bytes, size);
    if (source.byte() % 2)
        try_observation(source);
    else
        try_manifest(source);
    return 0;
}
