#include "scene/packing/packing_fields.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/errors.h"
#include "scene/packing/read_packing.h"

namespace mcdem::inline scene {
namespace {

/// Numbers have at least six digits in files, as C's %g prints them: each is right to half a unit of the
/// last.
constexpr double six_digits = 1e-5;

template <class Number>
std::optional<Number> whole_word(std::string_view word) {
    if (!word.empty() && word.front() == '+') word.remove_prefix(1);
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
    return value;
}

}  // namespace

std::optional<double> to_number(std::string_view word) {
    const auto value = whole_word<double>(word);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<long> to_whole_number(std::string_view word) { return whole_word<long>(word); }

std::string quoted(std::string_view word) { return fmt::format("\"{}\"", shortened(std::string(word))); }

void add_species(Packing& packing, std::string_view word) {
    constexpr std::size_t max_names = 64;  // more than a scene can have; the last one represents all others
    auto& names = packing.species_names;
    const auto found = std::ranges::find(names, word);
    const auto place = std::min(static_cast<std::size_t>(found - names.begin()), max_names - 1);
    packing.species.push_back(static_cast<int>(place));
    if (place == names.size()) names.emplace_back(word);
}

GrainColumns GrainColumns::named(const std::vector<std::string>& names, const std::string& file) {
    const auto first_of = [&](std::initializer_list<std::string_view> words) -> std::optional<std::size_t> {
        for (const std::string_view word : words)
            if (const auto found = std::ranges::find(names, word); found != names.end())
                return static_cast<std::size_t>(found - names.begin());
        return std::nullopt;
    };
    const auto x = first_of({"x", "xu"}), y = first_of({"y", "yu"}), z = first_of({"z", "zu"}),
               diameter = first_of({"diameter"}), radius = first_of({"radius", "r"});
    if (!x || !y || !z || (!diameter && !radius))
        throw InputError(
            fmt::format("{}: the columns must be x, y, z and diameter or radius, among others, got {}", file,
                        fmt::join(names, ", ")));
    for (const std::string_view word : {"x", "xu", "y", "yu", "z", "zu", "diameter", "radius", "r", "id",
                                        "species", "type", "density", "mass"})
        if (std::ranges::count(names, word) > 1)
            throw InputError(
                fmt::format("{}: the columns must name {} once, got {}", file, word, fmt::join(names, ", ")));
    return {*x,
            *y,
            *z,
            diameter ? *diameter : *radius,
            diameter ? 1.0 : 2.0,
            first_of({"id"}),
            first_of({"species", "type"}),
            diameter ? radius : std::nullopt,
            first_of({"density"}),
            first_of({"mass"})};
}

/// Density of a grain from its column or its mass.
void GrainRows::add_density(const std::vector<std::string_view>& words, long line) {
    const auto column = columns_.density ? columns_.density : columns_.mass;
    if (!column) return;
    const auto number = to_number(words[*column]);
    if (!number || !(*number > 0))
        problems_.add(line, fmt::format("{} must be a finite number > 0 [{}], got {}", names_[*column],
                                        columns_.density ? "kg/m3" : "kg", quoted(words[*column])));
    const double volume = std::numbers::pi / 6 * std::pow(packing_.diameter.back(), 3);
    packing_.density.push_back(columns_.density ? number.value_or(1) : number.value_or(1) / volume);
}

/// The vector in three columns from `first` on.
Vec3 GrainRows::vector(const std::vector<std::string_view>& words, std::size_t first, const char* unit,
                       long line) {
    Vec3 vector = Vec3::Zero();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto number = to_number(words[first + axis]);
        vector[static_cast<int>(axis)] = number.value_or(0);
        if (!number)
            problems_.add(line, fmt::format("{} must be a finite number [{}], got {}", names_[first + axis],
                                            unit, quoted(words[first + axis])));
    }
    return vector;
}

void GrainRows::add(const std::vector<std::string_view>& words, long line) {
    if (static_cast<long>(size()) >= largest_packing)
        return problems_.add(fmt::format("a packing must have at most {} grains, got more", largest_packing));
    double values[4] = {};
    const std::size_t columns[4] = {columns_.x, columns_.y, columns_.z, columns_.size};
    for (int k = 0; k < 4; ++k) {
        const auto number = to_number(words[columns[k]]);
        values[k] = number.value_or(1);
        if (!number || (k == 3 && !(*number > 0)))
            problems_.add(line, fmt::format("{} must be a finite number{} [m], got {}", names_[columns[k]],
                                            k == 3 ? " > 0" : "", quoted(words[columns[k]])));
    }
    packing_.position.emplace_back(values[0], values[1], values[2]);
    packing_.diameter.push_back(columns_.diameters * values[3]);
    if (columns_.radius) {
        const auto radius = to_number(words[*columns_.radius]);
        if (!radius || !(std::abs(2 * *radius - values[3]) <= 2 * six_digits * values[3]))
            problems_.add(line, fmt::format("the diameter must be twice the radius, got {} and {}: correct "
                                            "them, or leave one of the two columns out",
                                            quoted(words[columns_.size]), quoted(words[*columns_.radius])));
    }
    add_density(words, line);
    if (columns_.species) add_species(packing_, words[*columns_.species]);
    if (columns_.velocity) packing_.velocity.push_back(vector(words, *columns_.velocity, "m/s", line));
    if (columns_.spin) packing_.angular_velocity.push_back(vector(words, *columns_.spin, "1/s", line));
    const auto id = columns_.id ? to_number(words[*columns_.id]) : 0;
    if (!id) problems_.add(line, fmt::format("id must be a number, got {}", quoted(words[*columns_.id])));
    ids_.push_back(id.value_or(-1));
    lines_.push_back(line);
}

FilePacking GrainRows::packing() const {
    std::vector<std::size_t> order(size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return ids_[i]; });
    if (order.empty() && problems_.empty()) problems_.add("a packing must have at least 1 grain, got none");
    FilePacking sorted;
    for (std::size_t k = 0; k < order.size(); ++k) {
        if (columns_.id && k > 0 && ids_[order[k]] == ids_[order[k - 1]])
            problems_.add(lines_[order[k]],
                          fmt::format("each grain must have its own id, got {} again (first in line {})",
                                      ids_[order[k]], lines_[order[k - 1]]));
        sorted.position.push_back(packing_.position[order[k]]);
        sorted.diameter.push_back(packing_.diameter[order[k]]);
        if (columns_.species) sorted.species.push_back(packing_.species[order[k]]);
        if (columns_.velocity) sorted.velocity.push_back(packing_.velocity[order[k]]);
        if (columns_.spin) sorted.angular_velocity.push_back(packing_.angular_velocity[order[k]]);
        if (!packing_.density.empty()) sorted.density.push_back(packing_.density[order[k]]);
    }
    problems_.report();
    sorted.species_names = packing_.species_names;
    return sorted;
}

}  // namespace mcdem::scene
