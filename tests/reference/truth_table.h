// Tables of tests/truth by the names of their columns, and arrangements of plates.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "reference/plates_reference.h"

namespace mcdem::reference {

/// The cells of a row by the names of their columns.
struct TruthRow : std::map<std::string, std::string> {
    double number(const std::string& column) const { return std::stod(at(column)); }
};

inline std::vector<TruthRow> truth_table(const std::string& name) {
    std::ifstream file(MCDEM_SOURCE_DIR "/tests/truth/" + name);
    const auto cells = [](const std::string& line) {
        std::vector<std::string> all;
        std::stringstream text(line + ",");
        for (std::string cell; std::getline(text, cell, ',');) all.push_back(cell);
        return all;
    };
    std::vector<TruthRow> rows;
    std::string line;
    std::getline(file, line);
    const auto names = cells(line);
    while (std::getline(file, line)) {
        const auto values = cells(line);
        EXPECT_EQ(values.size(), names.size()) << name << ": " << line;
        rows.emplace_back();
        for (std::size_t i = 0; i < std::min(values.size(), names.size()); ++i)
            rows.back()[names[i]] = values[i];
    }
    return rows;
}

/// A direction and its mirror images at x = 0, y = 0 and z = 0, for this number of planes.
inline std::vector<Vec3> images(const Vec3& direction, int mirrors = 3) {
    std::vector<Vec3> all;
    for (int signs = 0; signs < 1 << mirrors; ++signs) {
        Vec3 image = direction.normalized();
        for (int axis = 0; axis < mirrors; ++axis)
            if (signs >> axis & 1) image[axis] *= -1;
        const auto is_image = [&](const Vec3& known) { return (known - image).norm() < 1e-9; };
        if (std::ranges::none_of(all, is_image)) all.push_back(image);
    }
    return all;
}

/// The images of several directions.
inline std::vector<Vec3> images_of(const std::vector<Vec3>& directions) {
    std::vector<Vec3> all;
    for (const Vec3& direction : directions) std::ranges::copy(images(direction), std::back_inserter(all));
    return all;
}

/// Plates in these directions, all with the same overlap.
inline std::vector<Plate> equal_plates(const std::vector<Vec3>& directions, double overlap) {
    std::vector<Plate> all;
    for (const Vec3& direction : directions) all.push_back({direction, overlap});
    return all;
}

}  // namespace mcdem::reference
