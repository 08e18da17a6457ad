// Changes the structure of the JSON documents and observations that the program reads back. They must be
// read or give an InputError. The first byte selects the document, the others the changes.
#include <map>

#include "challenge/files.h"
#include "challenge/results.h"
#include "challenge/truth.h"
#include "core/errors.h"
#include "core/sha256.h"
#include "diagnose/decide/diagnosis_json.h"
#include "diagnose/diagnosis_samples.h"
#include "diagnose/synthetic_evidence.h"
#include "ensemble/diagnosis/observation_store.h"
#include "ensemble/parts/manifest.h"
#include "fuzz/mutate_json.h"
#include "fuzz/scratch_folder.h"

namespace {

using namespace mcdem;
using fuzz::ByteSource;
using fuzz::scratch_folder;

struct Document {
    std::filesystem::path file;  ///< in the scratch folder
    std::string whole;
    void (*read)(const std::filesystem::path& file);
};

Evidence synthetic_evidence() {
    SyntheticWorld world(2, 1);
    Evidence evidence = world.evidence(2, 3);
    world.add_effect(evidence, "adhesion", world.pattern(0.1));
    world.add_nuisance(evidence, "modulus", world.pattern(1.0 / 3), 1);
    return evidence;
}

std::string truth() {
    Challenge challenge;
    challenge.packing_seeds = {1, 2};
    challenge.cases.resize(2);
    challenge.cases.front().folder = "case_0001";
    return truth_text(challenge);
}

const std::vector<Document>& documents() {
    static const Evidence evidence = synthetic_evidence();
    static const std::vector<Document> all{
        {"manifest.json", R"({"program": "0.1", "number of replicas": "4", "replicas of a part": "2"})",
         [](const std::filesystem::path& file) {
             read_manifest(file);
             keep_manifest(file, {{"program", "0.1"}, {"replicas of a part", "1"}}, "replicas of a part");
         }},
        {"challenge.json",
         open_challenge_text({std::string(64, 'a'),
                              std::string(64, 'b'),
                              {{"case_0001", std::nullopt}, {"case_0002", {{"adhesion"}}}}}),
         [](const std::filesystem::path& file) { read_open_challenge(file.parent_path()); }},
        {"library.json", library_text(evidence.library),
         [](const std::filesystem::path& file) { scatter(read_library(file)); }},
        {"evidence.json", evidence_text(evidence),
         [](const std::filesystem::path& file) { read_evidence(file, evidence.library); }},
        {"findings.json", findings_text({0.1, {"adhesion"}, {}, {1.0}, {}}),
         [](const std::filesystem::path& file) { read_findings(file); }},
        {"truth.json", truth(),
         [](const std::filesystem::path& file) { parse_truth(fuzz::bytes_of(file), "truth"); }},
        {"diagnosis.json", diagnosis_json(samples::diagnosis(Verdict::effect)),
         [](const std::filesystem::path& file) {
             diagnosis_json(diagnosis_of_json(fuzz::bytes_of(file), "diagnosis"));
         }},
    };
    return all;
}

void try_document(const Document& document, ByteSource& source) {
    const auto file = scratch_folder() / document.file;
    std::filesystem::create_directories(file.parent_path());
    fuzz::write_bytes(file, fuzz::mutate_json(document.whole, source));
    try {
        document.read(file);
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
    const std::size_t which = source.byte() % (documents().size() + 1);
    if (which == documents().size())
        try_observation(source);
    else
        try_document(documents()[which], source);
    return 0;
}
