#include "cli/shell/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "cli/shell/messages.h"
#include "cli/shell/standard_streams.h"

namespace mcdem::inline cli {
namespace {

constexpr double bar_interval = 0.1;     ///< between two drawings of the bar [s]
constexpr double line_interval = 10;     ///< a line is printed at least this often [s],
constexpr double line_step = 0.1;        ///< or after this much progress,
constexpr double shortest_interval = 1;  ///< but not more often than this [s]

int columns(std::FILE* out) {
    winsize size{};
    return ioctl(fileno(out), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

std::string duration_text(double seconds) {
    const long s = std::lround(seconds);
    if (s < 60) return fmt::format("{} s", s);
    if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
    return fmt::format("{} h {:02} min", s / 3600, s % 3600 / 60);
}

ProgressStyle progress_style(std::FILE* out) {
    const char* terminal = std::getenv("TERM");
    const bool dumb = !terminal || std::string(terminal) == "dumb";
    return isatty(fileno(out)) && !dumb ? ProgressStyle::bar : ProgressStyle::lines;
}

Progress::Progress(std::FILE* out, ProgressStyle style, std::function<Clock::time_point()> now)
    : out_(out), style_(style), now_(std::move(now)) {}

double Progress::seconds_since(const Moment& moment) const {
    return std::chrono::duration<double>(now_() - moment.time).count();
}

void Progress::show(double fraction) {
    fraction = std::clamp(fraction, 0.0, 1.0);
    const Moment moment{now_(), fraction};
    if (!first_) {
        first_ = moment;
        if (style_ == ProgressStyle::lines) last_ = moment;  // nothing to report yet
    }
    const double waited = last_ ? seconds_since(*last_) : 1e9;
    const double moved = last_ ? fraction - last_->fraction : 0;
    const bool due = style_ == ProgressStyle::bar
                         ? waited >= bar_interval
                         : waited >= line_interval || (moved >= line_step && waited >= shortest_interval);
    if (!due) return;
    last_ = moment;
    style_ == ProgressStyle::bar ? draw_bar(fraction) : print_line(fraction);
}

/// Estimate from the speed since the start; empty while it is too uncertain.
std::string Progress::time_left(double fraction) const {
    const double done = fraction - first_->fraction, seconds = seconds_since(*first_);
    if (done <= 0 || seconds < (done < 0.005 ? 20 : 1)) return "";
    return ", " + duration_text(seconds * (1 - fraction) / done) + " left";
}

void Progress::draw_bar(double fraction) {
    const auto text = fmt::format(" {:3.0f} %{}", std::floor(100 * fraction), time_left(fraction));
    const int width = std::clamp(columns(out_) - static_cast<int>(text.size()) - 3, 0, 50);
    const int full = static_cast<int>(fraction * width);
    // \033[K: clears the rest of the line
    write_text(out_, fmt::format("\r[{:#<{}}{:-<{}}]{}\033[K", "", full, "", width - full, text));
    std::fflush(out_);
    bar_is_there_ = true;
}

void Progress::print_line(double fraction) {
    write_text(out_,
               fmt::format("mcdem: {:.0f} % done{}\n", std::floor(100 * fraction), time_left(fraction)));
    std::fflush(out_);
}

void Progress::clear() {
    if (!bar_is_there_) return;
    write_text(out_, "\r\033[K");
    std::fflush(out_);
    bar_is_there_ = false;
}

}  // namespace mcdem::cli
