// Checks of the species and pairs of one setting.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/errors.h"
#include "scene/packing/sizes.h"
#include "scene/read/list_tables.h"
#include "scene/read/scene_checks.h"

namespace mcdem::inline scene {
namespace {

class SpeciesChecks {
public:
    SpeciesChecks(const Settings& settings, const std::set<std::string>& said,
                  const std::set<std::string, std::less<>>& bad)
        : settings_(settings),
          species_(settings.replica.species),
          pairs_(settings.replica.pairs),
          said_(said),
          bad_(bad) {}

    std::vector<CrossProblem> problems() {
        for (std::size_t n = 0; n < species_.size(); ++n)
            if (const auto key = gap("species", n); !key.empty())
                add(key, fmt::format("must be given too: there is a species {}", species_.size()));
            else
                check_name(n);
        for (std::size_t n = 0; n < pairs_.size(); ++n)
            if (const auto key = gap("pair", n); !key.empty())
                add(key, fmt::format("must be given too: there is a pair {}", pairs_.size()));
            else
                check_pair(n);
        if (problems_.empty()) check_fractions();
        if (settings_.packing_file.empty())
            for (std::size_t n = 0; n < species_.size(); ++n) check_sizes(n);
        if (problems_.empty() && settings_.packing_file.empty() && !species_.empty()) check_counts();
        return std::move(problems_);
    }

private:
    static std::string key(std::string_view table, std::size_t n, std::string_view field) {
        return fmt::format("{}.{}.{}", table, n + 1, field);
    }
    bool said(std::string_view table, std::size_t n, std::string_view field) const {
        return said_.contains(key(table, n, field));
    }
    void add(std::string key, std::string what) { problems_.push_back({std::move(key), std::move(what)}); }

    /// The first key of an element without keys.
    std::string gap(std::string_view table, std::size_t n) const {
        const auto keys = find_list_table(table)->keys(static_cast<int>(n));
        const bool any = std::ranges::any_of(keys, [&](const Key& one) {
            return said_.contains(std::string(one.name)) || bad_.contains(one.name);
        });
        return any ? "" : std::string(keys.front().name);
    }

    void check_name(std::size_t n) {
        const std::string& name = species_[n].name;
        if (bad_.contains(key("species", n, "name"))) return;
        if (name.empty())
            return add(key("species", n, "name"),
                       "must be given: results and [[pair]] call the species by it");
        if (name == walls_name)
            return add(key("species", n, "name"), "must be another word: walls means floor, plate and sides");
        for (std::size_t k = 0; k < n; ++k)
            if (species_[k].name == name)
                return add(
                    key("species", n, "name"),
                    fmt::format("must differ from that of species {}, got \"{}\" for both", k + 1, name));
    }

    bool is_known(const std::string& name) const {
        return std::ranges::find(species_, name, &Species::name) != species_.end();
    }

    std::string known_names() const {
        std::vector<std::string> names;
        for (const Species& one : species_) names.push_back(one.name);
        return names.empty() ? "none: give them as [[species]]" : fmt::format("{}", fmt::join(names, ", "));
    }

    void check_pair(std::size_t n) {
        const SpeciesPair& pair = pairs_[n];
        for (const auto& [field, name] : {std::pair("first", pair.first), std::pair("second", pair.second)}) {
            if (bad_.contains(key("pair", n, field))) return;
            const bool walls = name == walls_name && std::string_view(field) == "second";
            if (!walls && !is_known(name))
                return add(key("pair", n, field),
                           fmt::format("must be the name of a species{}, got {}; there are {}",
                                       std::string_view(field) == "second" ? " or walls" : "",
                                       name.empty() ? "none" : "\"" + name + "\"", known_names()));
        }
        if (!said("pair", n, "friction") && !said("pair", n, "restitution"))
            add(key("pair", n, "friction"),
                "must be given, or restitution: a pair needs at least one of them");
        if (pair.first == pair.second)
            add(key("pair", n, "second"),
                fmt::format("must be another species than first, got \"{}\" for both: what two of its grains "
                            "have is said by the species itself",
                            pair.first));
        for (std::size_t k = 0; k < n; ++k)
            if (std::set{pairs_[k].first, pairs_[k].second} == std::set{pair.first, pair.second})
                return add(key("pair", n, "first"),
                           fmt::format("and second must be two that no other pair has, got those of pair {}",
                                       k + 1));
    }

    void check_fractions() {
        double sum = 0;
        bool all = true, any = false;
        for (std::size_t n = 0; n < species_.size(); ++n) {
            if (bad_.contains(key("species", n, "fraction"))) return;
            any |= said("species", n, "fraction");
            all &= said("species", n, "fraction");
            if (said("species", n, "fraction")) sum += species_[n].fraction;
        }
        constexpr double rounding = 1e-6;
        if (any && (sum > 1 + rounding || (all && sum < 1 - rounding)))
            add(key("species", 0, "fraction"),
                fmt::format("and those of the other species must add up to {}, got {:.9g}",
                            all ? "1" : "at most 1", sum));
    }

    void check_sizes(std::size_t n) {
        const Sizes& sizes = species_[n].sizes;
        const auto leave_out = [&](std::string_view field) {
            if (said("species", n, field))
                add(key("species", n, field),
                    fmt::format("must be left out where sizes = \"{}\"", name(sizes.law)));
        };
        for (const auto field :
             {"diameter_mean", "diameter_sd", "diameter_min", "diameter_max", "diameter_file"})
            if (bad_.contains(key("species", n, field))) return;
        if (sizes.law == SizeLaw::table) {
            for (const auto field : {"diameter_mean", "diameter_sd", "diameter_min", "diameter_max"})
                leave_out(field);
            if (sizes.file.empty())
                return add(key("species", n, "diameter_file"), "must be given where sizes = \"table\"");
            if (sizes.table) return;
            try {
                read_diameters(sizes.file);
            } catch (const InputError& error) {
                for (const std::string& problem : error.problems())
                    add(key("species", n, "diameter_file"), problem);
            }
            return;
        }
        leave_out("diameter_file");
        if (sizes.law == SizeLaw::single)
            for (const auto field : {"diameter_sd", "diameter_min", "diameter_max"}) leave_out(field);
        if (!(sizes.min > 0))
            add(key("species", n, "diameter_min"),
                fmt::format("must be given: three standard deviations below the mean are {:.6g} m",
                            sizes.min));
        else if (!(sizes.min <= sizes.mean))
            add(key("species", n, "diameter_min"),
                fmt::format("must be at most diameter_mean = {}, got {}", sizes.mean, sizes.min));
        if (!(sizes.max >= sizes.mean))
            add(key("species", n, "diameter_max"),
                fmt::format("must be at least diameter_mean = {}, got {}", sizes.mean, sizes.max));
    }

    /// A species without grains is an error, usually a confusion of number and volume.
    void check_counts() {
        const int count = settings_.generated.count;
        const FractionsBy by = settings_.replica.packing.fractions_by;
        const auto counts = species_counts(count, species_, by);
        for (std::size_t n = 0; n < counts.size(); ++n)
            if (counts[n] == 0)
                add(key("species", n, "fraction"),
                    fmt::format("must leave the species a grain of the {} (packing.count), got {:.6g} by {}",
                                count, species_[n].fraction, name(by)));
    }

    const Settings& settings_;
    const std::vector<Species>& species_;
    const std::vector<SpeciesPair>& pairs_;
    const std::set<std::string>& said_;
    const std::set<std::string, std::less<>>& bad_;
    std::vector<CrossProblem> problems_;
};

}  // namespace

std::vector<CrossProblem> species_problems(const Settings& settings, const std::set<std::string>& said,
                                           const std::set<std::string, std::less<>>& bad) {
    return SpeciesChecks(settings, said, bad).problems();
}

}  // namespace mcdem::scene
