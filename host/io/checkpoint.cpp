#include "io/checkpoint.h"

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/look.h"
#include "io/hdf5.h"

namespace mcdem::inline io {
namespace {

namespace fs = std::filesystem;
constexpr long checkpoint_format = 5;

fs::path checkpoint_file(const fs::path& folder) { return folder / "checkpoint.h5"; }

void write_file(NewFile& out, const Checkpoint& checkpoint) {
    h5::File file = h5::File::create(out);
    file.make_group("/checkpoint/fields");
    file.set_attribute("/checkpoint", "format", std::vector<long>{checkpoint_format});
    file.set_attribute("/checkpoint", "device", checkpoint.device);
    file.set_attribute("/checkpoint", "segments", std::vector<long>{checkpoint.segments});
    file.set_attribute("/checkpoint", "fields",
                       std::vector<long>{static_cast<long>(checkpoint.fields.size())});
    file.write_texts("/checkpoint/scene", {checkpoint.scene_text});
    for (const auto& [name, bytes] : checkpoint.fields) {
        if (name.empty() || name.find('/') != std::string::npos)
            throw RunError(out.place().string() + ": checkpoint field '" + name + "' cannot be a name");
        // Uncompressed: floating-point state hardly compresses, and a checkpoint must not delay the run.
        h5::NewTable table(file, "/checkpoint/fields/" + name, h5::number_type<unsigned char>(), {},
                           h5::Storage::plain);
        table.append(bytes.data(), bytes.size());
        table.close();
    }
    file.close();
}

Checkpoint read_file(const fs::path& path) {
    const h5::File file = h5::File::open(path);
    const long format = file.integer_attribute("/checkpoint", "format");
    if (format != checkpoint_format)
        throw InputError(path.string() + ": has layout " + std::to_string(format) + ", expected " +
                         std::to_string(checkpoint_format) + ": resume with the version that wrote it");
    Checkpoint checkpoint;
    checkpoint.device = file.text_attribute("/checkpoint", "device");
    checkpoint.segments = static_cast<int>(file.integer_attribute("/checkpoint", "segments"));
    const auto scene = file.read_texts("/checkpoint/scene");
    if (!scene.empty()) checkpoint.scene_text = scene.front();
    for (const auto& name : file.members("/checkpoint/fields")) {
        const h5::Dataset table = file.dataset("/checkpoint/fields/" + name);
        table.expect_row({});
        auto& bytes = checkpoint.fields[name];
        bytes.resize(table.rows());
        table.read(h5::number_type<unsigned char>(), bytes.data(), 0, bytes.size());
    }
    const long fields = file.integer_attribute("/checkpoint", "fields");
    if (fields != static_cast<long>(checkpoint.fields.size()))
        throw InputError(fmt::format("{}: must have {} fields, got {}; the file is damaged", path.string(),
                                     fields, checkpoint.fields.size()));
    return checkpoint;
}

}  // namespace

void write_checkpoint(const fs::path& folder, const Checkpoint& checkpoint) {
    replace_file(checkpoint_file(folder), [&](NewFile& out) {
        write_file(out, checkpoint);
        out.close();
    });
}

std::optional<Checkpoint> read_checkpoint(const fs::path& folder) {
    if (!has_checkpoint(folder)) return std::nullopt;
    try {
        return read_file(checkpoint_file(folder));
    } catch (const InputError& error) {
        throw InputError({error.what(), folder.string() +
                                            ": the checkpoint cannot be read: start the run again "
                                            "in another folder"});
    }
}

bool has_checkpoint(const fs::path& folder) { return is_there(checkpoint_file(folder)); }

void remove_checkpoint(const fs::path& folder) { fs::remove(checkpoint_file(folder)); }

}  // namespace mcdem::io
