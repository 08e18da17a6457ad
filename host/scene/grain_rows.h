// Grains from the rows of a table with named columns.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/packing_fields.h"

namespace mcdem::inline scene {

/// Column numbers of a grain's values.
struct GrainColumns {
    std::size_t x, y, z, size;
    double diameters = 1;  ///< diameters per `size`: 2 for a radius
    std::optional<std::size_t> id, species;

    /// For columns x, y, z (or xu, yu, zu) and diameter, radius or r, optionally id and species or type.
    /// Throws InputError.
    static GrainColumns named(const std::vector<std::string>& names, const std::string& file);
};

/// The grains of one frame, ordered by id if there are ids, otherwise by row.
class GrainRows {
public:
    GrainRows(GrainColumns columns, std::vector<std::string> names, FileProblems& problems)
        : columns_(columns), names_(std::move(names)), problems_(problems) {}
    void add(const std::vector<std::string_view>& words, long line);
    std::size_t size() const { return packing_.size(); }
    /// Throws InputError if there were any problems.
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
