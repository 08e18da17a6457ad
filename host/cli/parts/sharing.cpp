#include "cli/parts/sharing.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "cli/shell/commands.h"
#include "cli/shell/interrupt.h"
#include "cli/shell/messages.h"
#include "cli/shell/progress.h"
#include "cli/shell/standard_streams.h"
#include "core/errors.h"

namespace mcdem::inline cli {
namespace {

using Numbers = std::vector<std::size_t>;

const char* const group = "Many devices and nodes";
constexpr int max_tries = 3;       ///< passes in which no part is finished
constexpr int all_is_merged = -1;  ///< instead of an exit code: everything is merged and must be reported
constexpr std::size_t max_shares = 1'000'000;

/// "3/8"; throws CLI::ValidationError.
WorkShare share_of(const std::string& text) {
    WorkShare share;
    const char* const end = text.data() + text.size();
    const auto number = std::from_chars(text.data(), end, share.number);
    const bool has_slash = number.ec == std::errc() && number.ptr != end && *number.ptr == '/';
    const auto of = std::from_chars(has_slash ? number.ptr + 1 : end, end, share.of);
    if (!has_slash || of.ec != std::errc() || of.ptr != end || share.number < 1 || share.number > share.of ||
        share.of > max_shares)
        throw CLI::ValidationError(
            "--part",
            fmt::format("must be I/N, the I-th of N shares of the parts, as in 3/8; got '{}'", text));
    return share;
}

/// The missing parts of the share that can be computed now.
Numbers missing_of(PartedWork& parts, const WorkShare& share) {
    Numbers own = parts.missing();
    std::erase_if(own, [&](std::size_t part) { return part % share.of != share.number - 1; });
    return own;
}

/// The missing parts. If none is missing they are merged; the result is empty after the merge. A damaged
/// part counts as missing.
Numbers left_to_compute(PartedWork& parts) {
    Numbers left = parts.missing();
    while (left.empty() && !parts.merge()) left = parts.missing();
    return left;
}

void compute(PartedWork& parts, const Numbers& numbers, Device& device) {
    Progress progress(stderr, progress_style(stderr));
    double done = 0;
    const auto all = static_cast<double>(numbers.size());
    parts.on_progress = [&](double fraction) { progress.show((done + fraction) / all); };
    for (const std::size_t part : numbers) {
        parts.compute(device, part);
        ++done;
    }
}

/// Computes what `left` returns until that is nothing.
void compute_until_done(const SharedWork& work, PartedWork& parts, const std::string& device,
                        const std::function<Numbers()>& left) {
    Device chosen(device);
    work.check(chosen);
    int tries = 0;
    for (Numbers before, now; !(now = left()).empty(); before = now) {
        tries = now == before ? tries + 1 : 0;
        if (tries == max_tries)
            throw RunError(work.out.string() + ": no part could be finished: fix the errors above first");
        compute(parts, now, chosen);
    }
}

int compute_share(const SharedWork& work, PartedWork& parts, const WorkShare& share,
                  const std::string& device) {
    compute_until_done(work, parts, device, [&] { return missing_of(parts, share); });
    if (const auto others = parts.missing(); !others.empty())
        spdlog::info("share {}/{} is done; parts that are still missing: {} of {}", share.number, share.of,
                     others.size(), parts.count());
    return exit_done;
}

int merge_only(const SharedWork& work, PartedWork& parts) {
    const Numbers left = left_to_compute(parts);
    if (left.empty()) return all_is_merged;
    spdlog::error("{}: {} of {} parts {} missing; the command without --merge computes {}", work.out.string(),
                  left.size(), parts.count(), left.size() == 1 ? "is" : "are",
                  left.size() == 1 ? "it" : "them");
    return exit_failed;
}

/// Signals interrupt all of it.
int compute_or_merge(const SharedWork& work, PartedWork& parts, const SharingOptions& options,
                     const std::string& device) {
    const char* const go_on = "results are kept in {}; run the same command again to continue";
    try {
        const Interrupt interrupt;
        if (options.share) return compute_share(work, parts, *options.share, device);
        if (options.merge) return merge_only(work, parts);
        compute_until_done(work, parts, device, [&] { return left_to_compute(parts); });
        return all_is_merged;
    } catch (const Interrupted&) {
        spdlog::warn("interrupted; {}", fmt::format(fmt::runtime(go_on), work.out.string()));
        return exit_interrupted;
    } catch (const cl::Error& error) {
        const int code = report_error(error);
        spdlog::warn(fmt::runtime(go_on), work.out.string());
        return code;
    }
}

/// An option of earlier versions that ends with the remedy.
void add_replaced(CLI::App& command, const std::string& name, const std::string& remedy) {
    command.add_flag_callback(name, [name, remedy] { throw CLI::ValidationError(name, remedy); })->group("");
}

}  // namespace

void add_sharing_options(CLI::App& command, SharingOptions& options, std::string& device) {
    options.command = &command;
    command
        .add_option("--device", device,
                    "Number or part of the name of a device, as `mcdem devices` lists them")
        ->type_name("DEVICE")
        ->check([](const std::string& name) {
            return name == "all" ? "start the command by `mcdem distribute`, which uses every device of one "
                                   "kind, as in: mcdem distribute run .."
                                 : "";
        });
    command
        .add_option_function<std::string>(
            "--part", [&options](const std::string& text) { options.share = share_of(text); },
            "Compute only the I-th of N shares of the work: one process each, anywhere")
        ->type_name("I/N")
        ->group(group);
    command
        .add_flag("--missing", options.missing,
                  "List the parts that can be computed now, as --part takes them")
        ->group(group)
        ->excludes("--part");
    command.add_flag("--merge", options.merge, "Merge the parts, or report how many are missing")
        ->group(group)
        ->excludes("--part")
        ->excludes("--missing");
    command
        .add_option("--workers", options.workers,
                    "Number of processes among which the work is divided; default: N of --part")
        ->check(CLI::Range(1, 100'000))
        ->type_name("N")
        ->group(group);
    for (const char* name : {"--mpi", "--slurm"})
        add_replaced(
            command, name,
            "start one process per task with --part I/N, then one with --merge, or use `mcdem distribute` "
            "(host/ensemble/README.md)");
}

std::vector<std::string> words_of(const SharingOptions& options) {
    std::vector<std::string> words;
    for (const CLI::App* app = options.command; app->get_parent(); app = app->get_parent())
        words.insert(words.begin(), app->get_name());
    for (const CLI::Option* option : options.command->get_options()) {
        const std::string name = option->get_name();
        if (name == "--resume" || name == "--device" || option->get_group() == group) continue;
        for (const std::string& value : option->results()) {
            if (!option->get_positional()) words.push_back(name);
            if (option->get_items_expected_max() > 0) words.push_back(value);
        }
    }
    return words;
}

bool is_shared(const SharingOptions& options) { return options.share || options.missing || options.merge; }

int share(const SharedWork& work, const SharingOptions& options, const std::string& device) {
    auto parts = work.begin(options.share ? std::max(options.workers, options.share->of) : options.workers);
    if (options.missing) {
        for (const std::size_t part : parts->missing()) print_out("{}/{}\n", part + 1, parts->count());
        return exit_done;
    }
    const int code = compute_or_merge(work, *parts, options, device);
    parts.reset();  // releases its lock
    return code == all_is_merged ? work.report() : code;
}

}  // namespace mcdem::cli
