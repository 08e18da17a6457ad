#include "io/parts.h"

#include "core/errors.h"
#include "io/result_file.h"

namespace mcdem::inline io {
namespace {

namespace fs = std::filesystem;

/// Reads part `number`. Errors in its file are InputErrors, as for any other damaged file.
template <class Read>
auto from_part(std::size_t number, Read read) {
    try {
        return read();
    } catch (const InputError& error) {
        throw DamagedPart(number, error.what());
    }
}

}  // namespace

fs::path parts_folder(const fs::path& folder) { return folder / "parts"; }

void merge_parts(const std::vector<fs::path>& parts, const fs::path& merged, const StopWanted& stop_wanted) {
    Run all;
    std::vector<std::size_t> first{0};  // replica of each part
    for (std::size_t p = 0; p < parts.size(); ++p) {
        if (stop_wanted()) throw Interrupted();
        Run part = from_part(p, [&] { return read_run_header({parts[p]}); });
        if (p == 0)
            all = std::move(part);
        else
            std::ranges::move(part.recordings, std::back_inserter(all.recordings));
        first.push_back(all.recordings.size());
    }
    const auto write = [&](ResultWriter& writer) {
        for (std::size_t p = 0; p < parts.size(); ++p) {
            const ResultFile file = from_part(p, [&] { return ResultFile(parts[p]); });
            for (std::size_t r = first[p]; r < first[p + 1]; ++r) {
                auto scans = from_part(
                    p, [&] { return file.scans(all.recordings[r], r - first[p], ReadWhat::everything); });
                for (Scan& scan : scans) writer.append(r, std::move(scan));
                writer.end(r, all.recordings[r].failure);
            }
        }
    };
    write_result_file(merged, all, write, stop_wanted);
}

}  // namespace mcdem::io
