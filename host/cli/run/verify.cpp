#include "ensemble/verify.h"

#include "cli/shell/commands.h"
#include "cli/shell/standard_streams.h"

namespace mcdem::inline cli {
namespace {

int print_verified(const std::vector<std::string>& paths) {
    bool all_good = true;
    for (const std::string& path : paths)
        for (const Verified& file : verify(path)) {
            print_out("{}: {}{}{}\n", file.file.string(),
                      file.is_good ? "no damage found" : "DAMAGED OR CHANGED", file.note.empty() ? "" : ": ",
                      file.note);
            all_good = all_good && file.is_good;
        }
    return all_good ? exit_done : exit_failed;
}

}  // namespace

void add_verify(CLI::App& app, int& exit_code) {
    auto* sub = app.add_subcommand("verify", "Check files against their SHA-256 digests");
    auto paths = std::make_shared<std::vector<std::string>>();
    sub->add_option(
           "FOLDER", *paths,
           "Folder of a run, an experiment of `experiment from-run`, a diagnosis or a library; or one file")
        ->required();
    sub->footer(
        "Reads every file completely and reports whether it is damaged or changed; the exit code is 1 if one "
        "is.\n"
        "Examples:\n"
        "  mcdem verify out/small");
    sub->callback([paths, &exit_code] { exit_code = print_verified(*paths); });
}

}  // namespace mcdem::cli
