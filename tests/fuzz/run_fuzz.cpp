// Changes the structure of result files and checkpoints: every reader returns data or throws an InputError.
// The first byte selects the kind of file, the others the changes.
#include "core/errors.h"
#include "ensemble/make_packings.h"
#include "ensemble/small_scene.h"
#include "fuzz/mutate_hdf5.h"
#include "fuzz/scratch_folder.h"
#include "io/checkpoint.h"
#include "io/csv.h"
#include "io/result_folder.h"
#include "io/results.h"
#include "io/synthetic_run.h"
#include "sim/simulation.h"

/// HDF5 1.10 leaks memory when it reads damaged metadata; these leaks are not checked here.
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

namespace {

using namespace mcdem;
using fuzz::ByteSource;
using fuzz::scratch_folder;

/// Errors in a file are reported. A file that claims an enormous size may also cause std::bad_alloc.
template <class Read>
void expect_read_or_refused(Read read) {
    try {
        read();
    } catch (const InputError&) {
    } catch (const RunError&) {
    } catch (const std::bad_alloc&) {
    }
}

void read_with_everything(const std::filesystem::path& path) {
    for (const ReadWhat what : {ReadWhat::observables, ReadWhat::positions, ReadWhat::contacts})
        expect_read_or_refused([&] { read_run(path, what); });
    expect_read_or_refused([&] { csv_text(read_run(path)); });
    expect_read_or_refused([&] {
        RunReader reader(path);
        for (std::size_t r = 0; r < reader.run().recordings.size(); ++r)
            for (std::size_t s = 0; s < reader.run().recordings[r].scans.size(); ++s) reader.read_scan(r, s);
    });
}

void try_run(ByteSource& source) {
    static const std::string whole = [] {
        write_run(scratch_folder() / "run.h5", test::synthetic_run({2, 8, 4, "float"}));
        return fuzz::bytes_of(scratch_folder() / "run.h5");
    }();
    fuzz::write_bytes(scratch_folder() / "run.h5", whole);
    fuzz::mutate_hdf5(scratch_folder() / "run.h5", source);
    read_with_everything(scratch_folder());
}

/// A small simulation with all kinds of contact memory.
class Restarted {
public:
    Restarted()
        : scene_(small_scene({"packing.count=8", "contact.friction_law=mindlin", "effects.plasticity=0.1",
                              "effects.viscoelasticity=0.1", "box.size_x=0.05", "box.size_y=0.05",
                              "plate.start=0.05", "plate.end=0.045"})),
          simulation_(device_, scene_, make_packings(scene_)) {
        for (int round = 0; round < 3; ++round) advance();
        simulation_.pass_on(ignore_scan_, ignore_failure_);
        saved_.scene_text = scene_.text;
        saved_.device = device_.description();
        saved_.segments = 1;
        saved_.fields = simulation_.save();
    }
    const Checkpoint& saved() const { return saved_; }
    void resume_from(const Checkpoint& checkpoint) {
        simulation_.restore(checkpoint.fields);
        for (int round = 0; round < 2; ++round) advance();
    }

private:
    void advance() { simulation_.advance(ignore_scan_, ignore_failure_); }
    const Simulation::ScanSink ignore_scan_ = [](int, const Scan&) {};
    const Simulation::FailureSink ignore_failure_ = [](int, const Failure&) {};
    Device device_;
    Scene scene_;
    Simulation simulation_;
    Checkpoint saved_;
};

/// The checkpoint is written anew with its checksums, so that the contents are accepted.
void try_checkpoint(ByteSource& source) {
    static Restarted simulation;
    Checkpoint checkpoint = simulation.saved();
    for (int change = 0; change < 4 && !source.empty(); ++change) {
        auto field = checkpoint.fields.begin();
        std::advance(field, static_cast<std::ptrdiff_t>(source.below(checkpoint.fields.size())));
        auto& bytes = field->second;
        const std::int64_t whole = source.integer();
        const auto single = static_cast<float>(source.number());
        if (source.byte() % 16 == 0)
            bytes.resize(source.below(2 * bytes.size() + 1));
        else if (bytes.size() >= 4)
            std::memcpy(&bytes[4 * source.below(bytes.size() / 4)],
                        source.byte() % 2 ? static_cast<const void*>(&single) : &whole, 4);
    }
    write_checkpoint(scratch_folder(), checkpoint);
    if (source.byte() % 4 == 0) fuzz::mutate_hdf5(scratch_folder() / "checkpoint.h5", source);
    expect_read_or_refused([&] {
        if (const auto read = read_checkpoint(scratch_folder())) simulation.resume_from(*read);
    });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    ByteSource source(bytes, size);
    if (source.byte() % 3)
        try_run(source);
    else
        try_checkpoint(source);
    return 0;
}
