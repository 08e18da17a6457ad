// mcdem challenge score
#include "challenge/figure_values.h"
#include "challenge/truth.h"
#include "cli/challenge/challenge_tables.h"
#include "cli/run/figures.h"
#include "cli/shell/commands.h"
#include "cli/shell/messages.h"
#include "cli/shell/progress.h"
#include "cli/shell/standard_streams.h"
#include "core/errors.h"
#include "core/output_file.h"
#include "io/result_folder.h"

namespace mcdem::inline cli {
namespace {

struct ScoreCommand {
    std::string challenge, out, truth;
    bool no_figures = false;
};

void print(const ChallengeScore& score) {
    print_out("{}\n{}\n", to_text(table_of_merits(score), TableFormat::terminal),
              to_text(table_of_arms(score), TableFormat::terminal));
}

void expect_folder(const std::filesystem::path& answers) {
    if (!std::filesystem::is_directory(answers))
        throw InputError(answers.string() + ": must be the folder of the diagnoses, got none");
}

void score(const ScoreCommand& command) {
    const std::filesystem::path folder = command.challenge, out = command.out;
    const OpenChallenge open = read_open_challenge(folder);
    const Challenge truth = open_truth(
        command.truth.empty() ? folder / "truth.json" : std::filesystem::path(command.truth), open.sealed);
    expect_folder(out);
    const FolderLock lock = open_output_folder(out);
    expect_replaceable(out / "score.json", FileKind::score);
    expect_replaceable(out / "score.md", FileKind::score_page);
    ChallengeScore score;
    {
        Progress progress(stderr, progress_style(stderr));
        score = score_challenge(truth, open, out, [&](double fraction) { progress.show(fraction); });
    }
    for (const std::string& problem : score.not_diagnosed) spdlog::warn("not diagnosed: {}", problem);
    print(score);
    replace_own(out / "score.json", FileKind::score, score_json(score));
    replace_own(out / "score.md", FileKind::score_page, score_markdown(score));
    print_out("wrote {}\nwrote {}\n", (out / "score.json").string(), (out / "score.md").string());
    if (command.no_figures) return;
    for (const auto& figure : draw_if_possible([&] { return draw_figures(out, score_figure_values(score)); }))
        print_out("wrote {}\n", figure.string());
}

}  // namespace

void add_challenge_score(CLI::App& challenge, int&) {
    auto* sub = challenge.add_subcommand("score", "Compare the diagnoses with the answers");
    auto command = std::make_shared<ScoreCommand>();
    sub->add_option("CHALLENGE", command->challenge, "Folder of the challenge")->required();
    sub->add_option("ANSWERS", command->out, "Folder of the diagnoses; the score is written to it")
        ->required();
    sub->add_option("--truth", command->truth, "File with the answers; default: CHALLENGE/truth.json")
        ->type_name("FILE");
    sub->add_flag("--no-figures", command->no_figures, "Do not draw figures");
    sub->footer(
        "Answers whose SHA-256 is not the one in challenge.json are refused.\n"
        "Example:\n"
        "  mcdem challenge score out/challenge out/answers");
    sub->callback([command] { score(*command); });
}

}  // namespace mcdem::cli
