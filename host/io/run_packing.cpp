#include "io/run_packing.h"

#include <fmt/format.h>

#include "core/errors.h"
#include "io/results.h"

namespace mcdem::inline io {

Packing packing_of_run(const std::filesystem::path& file, std::optional<long> frame) {
    RunReader reader(file);
    const auto& recordings = reader.run().recordings;
    if (recordings.size() != 1)
        throw InputError(
            fmt::format("{}: must hold one replica where it is a packing, got {}: make an experiment of one "
                        "(mcdem experiment from-run), and read its grains.csv",
                        file.string(), recordings.size()));
    const Recording& recording = recordings.front();
    for (std::size_t s = 0; s < recording.scans.size(); ++s) {
        if (frame && recording.scans[s].frame != *frame) continue;
        Scan scan = reader.read_scan(0, s);
        if (!scan.position.empty())
            return {std::move(scan.position), recording.diameter, recording.species, recording.species_names};
        if (frame) break;
    }
    throw InputError(fmt::format("{}: must hold positions of {}, got none: run with output.positions = true",
                                 file.string(), frame ? fmt::format("frame {}", *frame) : "a frame"));
}

}  // namespace mcdem::io
