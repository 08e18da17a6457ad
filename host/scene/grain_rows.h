// Grains from the rows of a table whose columns have names.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/packing_fields.h"

namespace mcdem::inline scene {

/// Where a row has its grain.
struct GrainColumns {
    std::size_t x, y, z, size;
    double diameters = 1;  ///< of what `size` states: 2 for a radius
    std::optional<std::size_t> id, species;

    /// Of columns x, y, z (or xu, yu, zu) and diameter, radius or r, perhaps id and species or type. Throws
    /// InputError.
    static GrainColumns named(const std::vector<std::string>& names, const std::string& file);
};

/// The grains of one frame, in the order of their ids where there are any, else of the rows.
class GrainRows {
public:
    GrainRows(GrainColumns columns, std::vector<std::string> names, FileProblems& problems)
        : columns_(columns), names_(std::move(names)), problems_(problems) {}
    void add(const std::vector<std::string_view>& words, long line);
    std::size_t size() const { return packing_.size(); }
    /// Throws InputError where there was any problem.
    Packing packing() const;

private:
    GrainColumns columns_;
    std::vector<std::string> names_;
    FileProblems& problems_;
    Packing packing_;
    std::vector<double> ids_;
    std::vector<long> lines_;
};

}  // namespace mcdem::scene
