// The parts of check_experiment, each in the file of its name.
#pragma once
#include <fmt/format.h>

#include <optional>

#include "experiment/check_experiment.h"

namespace mcdem::inline experiment {

/// Counts findings of one kind over the frames and keeps an example.
class Tally {
public:
    /// The first one is the example; others are only counted.
    template <class... Args>
    void add(const Scan& scan, fmt::format_string<Args...> example, Args&&... args) {
        if (count_++ == 0) {
            first_ = scan.frame;
            example_ = fmt::format(example, std::forward<Args>(args)...);
        }
        if (last_ != scan.frame) ++frames_;
        last_ = scan.frame;
    }
    long count() const { return count_; }
    /// "3 in 2 frames, first in frame 7: <example>"
    std::string text() const;

private:
    long count_ = 0, frames_ = 0;
    int first_ = -1, last_ = -1;
    std::string example_;
};

/// Findings about a file; texts are formats and their arguments.
class Findings {
public:
    template <class... Args>
    void note(const std::string& about, fmt::format_string<Args...> text, Args&&... args) {
        all_.push_back({Severity::note, about, fmt::format(text, std::forward<Args>(args)...)});
    }
    template <class... Args>
    void missing(const std::string& about, fmt::format_string<Args...> text, Args&&... args) {
        all_.push_back({Severity::missing, about, fmt::format(text, std::forward<Args>(args)...)});
    }
    template <class... Args>
    void odd(const std::string& about, fmt::format_string<Args...> text, Args&&... args) {
        all_.push_back({Severity::odd, about, fmt::format(text, std::forward<Args>(args)...)});
    }
    /// The text and what was found, where anything was.
    template <class... Args>
    void odd(const std::string& about, const Tally& found, fmt::format_string<Args...> text, Args&&... args) {
        if (found.count()) odd(about, "{}{}", fmt::format(text, std::forward<Args>(args)...), found.text());
    }
    const std::vector<Finding>& all() const { return all_; }

private:
    std::vector<Finding> all_;
};

inline constexpr auto settings_file = "experiment.toml";
inline constexpr auto plate_file = "plate.csv";
inline constexpr auto grains_file = "grains.csv";
inline constexpr auto contacts_file = "contacts.csv";

inline const Vec3& at(const std::vector<Vec3>& position, int grain) { return position[grain]; }
inline double radius_of(const Recording& recording, int grain) { return 0.5 * recording.diameter[grain]; }
const std::vector<Wall>& walls_of(const Box& box);  ///< existing walls
std::string container_words(const Box& box);        ///< "box of 165 by 166 mm"
double mean_diameter(const Recording& recording);
std::optional<double> material(const Experiment& experiment, const std::string& key);

void describe(const Experiment& experiment, Findings& findings);
void find_missing(const Experiment& experiment, Findings& findings);
void check_errors(const Experiment& experiment, Findings& findings);
void check_plate(const Experiment& experiment, Findings& findings);
void check_grains(const Experiment& experiment, Findings& findings);
void check_contacts(const Experiment& experiment, Findings& findings);
void check_plate_load(const Experiment& experiment, Findings& findings);
void check_balance(const Experiment& experiment, Findings& findings);

}  // namespace mcdem::experiment
