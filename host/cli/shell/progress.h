// Progress and remaining time: a bar on a terminal, otherwise lines of text.
#pragma once
#include <chrono>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>

namespace mcdem::inline cli {

enum class ProgressStyle { bar, lines };

/// A bar if `out` is a terminal that can redraw its line.
ProgressStyle progress_style(std::FILE* out);

class Progress {
public:
    using Clock = std::chrono::steady_clock;
    Progress(std::FILE* out, ProgressStyle style, std::function<Clock::time_point()> now = Clock::now);
    ~Progress() { clear(); }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Shows the completed fraction of the work. Draws only if something has changed.
    void show(double fraction);
    /// Removes the bar before other output; the next show() draws it again.
    void clear();

private:
    struct Moment {
        Clock::time_point time;
        double fraction;
    };
    double seconds_since(const Moment& moment) const;
    std::string time_left(double fraction) const;
    void draw_bar(double fraction);
    void print_line(double fraction);

    std::FILE* out_;
    ProgressStyle style_;
    std::function<Clock::time_point()> now_;
    std::optional<Moment> first_;  ///< a resumed run does not start at 0
    std::optional<Moment> last_;   ///< time of the last drawing
    bool bar_is_there_ = false;
};

/// "42 s", "3 min 20 s", "2 h 05 min".
std::string duration_text(double seconds);

}  // namespace mcdem::cli
