// The parts of check_experiment, each in the file of its name.
#pragma once
#include <functional>
#include <optional>

#include "experiment/check_experiment.h"

namespace mcdem::inline experiment {

/// Counts findings of one kind over the frames and keeps an example.
class Tally {
public:
    /// `example` is called only once.
    void add(const Scan& scan, const std::function<std::string()>& example);
    long count() const { return count_; }
    /// "3 in 2 frames, first in frame 7: <example>"
    std::string text() const;

private:
    long count_ = 0, frames_ = 0;
    int first_ = -1, last_ = -1;
    std::string example_;
};

class Findings {
public:
    void note(const std::string& about, const std::string& text) { add(Severity::note, about, text); }
    void missing(const std::string& about, const std::string& text) { add(Severity::missing, about, text); }
    void odd(const std::string& about, const std::string& text) { add(Severity::odd, about, text); }
    /// The text and what was found, where anything was.
    void odd(const std::string& about, const std::string& text, const Tally& tally) {
        if (tally.count()) odd(about, text + tally.text());
    }
    const std::vector<Finding>& all() const { return all_; }

private:
    void add(Severity severity, const std::string& about, const std::string& text) {
        all_.push_back({severity, about, text});
    }
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
