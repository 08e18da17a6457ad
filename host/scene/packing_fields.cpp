#include "scene/packing_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/errors.h"
#include "scene/problems.h"

namespace mcdem::inline scene {
namespace {

constexpr std::size_t max_problems = 20;

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

void FileProblems::add(long line, const std::string& what) {
    if (!full()) problems_.push_back(fmt::format("{}:{}: {}", source_, line, what));
}

void FileProblems::add(const std::string& what) {
    if (!full()) problems_.push_back(fmt::format("{}: {}", source_, what));
}

bool FileProblems::full() const { return problems_.size() >= max_problems; }

void FileProblems::report() const {
    if (!empty()) throw InputError(problems_);
}

void add_grain(Packing& packing, std::string_view x, std::string_view y, std::string_view z,
               std::string_view diameter, long line, FileProblems& problems) {
    const std::string_view words[4] = {x, y, z, diameter};
    constexpr const char* names[4] = {"x", "y", "z", "diameter"};
    double values[4] = {};
    for (int k = 0; k < 4; ++k) {
        const auto value = to_number(words[k]);
        if (!value)
            problems.add(line,
                         fmt::format("{} must be a finite number [m], got {}", names[k], quoted(words[k])));
        else if (k == 3 && *value <= 0)
            problems.add(line, fmt::format("diameter must be > 0 [m], got {}", *value));
        values[k] = value.value_or(0);
    }
    packing.position.emplace_back(values[0], values[1], values[2]);
    packing.diameter.push_back(values[3]);
}

void add_species(Packing& packing, std::string_view word) {
    constexpr std::size_t max_names = 64;  // more than a scene can have; the last one represents all others
    auto& names = packing.species_names;
    const auto found = std::ranges::find(names, word);
    const auto place = std::min(static_cast<std::size_t>(found - names.begin()), max_names - 1);
    packing.species.push_back(static_cast<int>(place));
    if (place == names.size()) names.emplace_back(word);
}

}  // namespace mcdem::scene
