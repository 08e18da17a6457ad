// A packing of one frame of a dump, or of Yade's text.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

#include "core/errors.h"
#include "scene/foreign_table.h"
#include "scene/read_packing.h"

namespace mcdem {
namespace {

/// The first of these names that the table has.
std::optional<std::size_t> first_of(const ForeignTable& table,
                                    std::initializer_list<std::string_view> names) {
    for (const std::string_view name : names)
        if (const auto column = table.find(name)) return column;
    return std::nullopt;
}

struct GrainColumns {
    std::size_t x, y, z, size;
    double diameters;  ///< of what `size` states
    std::optional<std::size_t> id;
};

GrainColumns grain_columns(const ForeignTable& table) {
    const bool yade = table.format == TableFormat::text && !table.named && table.columns.size() >= 4;
    if (yade) return {0, 1, 2, 3, 2, std::nullopt};
    const auto x = first_of(table, {"x", "xu"}), y = first_of(table, {"y", "yu"}),
               z = first_of(table, {"z", "zu"});
    const auto diameter = table.find("diameter"), radius = first_of(table, {"radius", "r"});
    if (!x || !y || !z || (!diameter && !radius))
        throw InputError(
            fmt::format("{}: the columns must be x, y, z and diameter or radius, among others, got {}",
                        table.file, fmt::join(table.columns, ", ")));
    return {*x, *y, *z, diameter ? *diameter : *radius, diameter ? 1.0 : 2.0, table.find("id")};
}

/// The rows of the frame: first and behind the last.
std::pair<std::size_t, std::size_t> rows_of(const ForeignTable& table, std::optional<long> step) {
    const auto& frames = table.frames;
    if (frames.empty() && step)
        throw InputError(
            fmt::format("{}: must be a dump where packing.frame is given, got one packing", table.file));
    if (frames.empty()) return {0, table.rows()};
    auto frame =
        step ? std::ranges::find(frames, *step, &ForeignTable::Frame::step) : std::prev(frames.end());
    if (frame == frames.end())
        throw InputError(fmt::format("{}: the frame must be one of its {} timesteps, {} to {}, got {}",
                                     table.file, frames.size(), frames.front().step, frames.back().step,
                                     *step));
    const auto next = std::next(frame);
    return {frame->first_row, next == frames.end() ? table.rows() : next->first_row};
}

class PackingReader {
public:
    explicit PackingReader(const ForeignTable& table)
        : table_(table), columns_(grain_columns(table)), problems_(table.file) {}

    Packing read(std::size_t first, std::size_t last) {
        std::vector<std::size_t> order(last - first);
        std::iota(order.begin(), order.end(), first);
        if (columns_.id) sort_by_id(order);
        if (order.empty()) problems_.add("a packing must have at least 1 grain, got none");
        if (order.size() > static_cast<std::size_t>(largest_packing))
            problems_.add(fmt::format("a packing must have at most {} grains, got more", largest_packing));
        else
            for (const std::size_t row : order) add(row);
        problems_.report();
        return packing_;
    }

private:
    void sort_by_id(std::vector<std::size_t>& order) {
        const auto id = [&](std::size_t row) { return table_.number(row, *columns_.id).value_or(-1); };
        std::ranges::stable_sort(order, {}, id);
        for (std::size_t k = 1; k < order.size() && !problems_.full(); ++k)
            if (id(order[k]) == id(order[k - 1]))
                wrong(order[k], fmt::format("each grain must have its own id, got {} again",
                                            quoted(table_.cell(order[k], *columns_.id))));
    }

    void add(std::size_t row) {
        double values[4] = {};
        const std::size_t columns[4] = {columns_.x, columns_.y, columns_.z, columns_.size};
        for (int k = 0; k < 4 && !problems_.full(); ++k) {
            const auto number = table_.number(row, columns[k]);
            values[k] = number.value_or(1);
            if (!number || (k == 3 && !(*number > 0)))
                wrong(row, fmt::format("{} must be a finite number{} [m], got {}", table_.columns[columns[k]],
                                       k == 3 ? " > 0" : "", quoted(table_.cell(row, columns[k]))));
        }
        packing_.position.emplace_back(values[0], values[1], values[2]);
        packing_.diameter.push_back(columns_.diameters * values[3]);
    }

    void wrong(std::size_t row, const std::string& what) { problems_.add_at(table_.where(row), what); }

    const ForeignTable& table_;
    GrainColumns columns_;
    FileProblems problems_;
    Packing packing_;
};

}  // namespace

Packing packing_of(const ForeignTable& table, std::optional<long> step) {
    const auto [first, last] = rows_of(table, step);
    return PackingReader(table).read(first, last);
}

}  // namespace mcdem
