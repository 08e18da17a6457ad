// An unstructured grid in a VTKHDF file, version 1.0.
#pragma once
#include <string>
#include <vector>

#include "core/recording.h"
#include "io/hdf5.h"

namespace mcdem::inline io {

/// Cell types of VTK.
enum class VtkCell : unsigned char { vertex = 1, line = 3, polygon = 7 };

/// Points, and cells of any type in sequence.
struct VtkCells {
    std::vector<double> points;  ///< three numbers each
    std::vector<long> offsets{0};
    std::vector<unsigned char> types;

    /// Adds a cell with points of its own.
    void add(VtkCell type, const std::vector<Vec3>& corners);
};

class VtkGrid {
public:
    VtkGrid(NewFile& out, const VtkCells& cells);

    template <class Number>
    void point_data(const std::string& name, const std::vector<Number>& values, const h5::Extent& row = {}) {
        file_.write("/VTKHDF/PointData/" + name, values, row);
    }
    template <class Number>
    void cell_data(const std::string& name, const std::vector<Number>& values, const h5::Extent& row = {}) {
        file_.write("/VTKHDF/CellData/" + name, values, row);
    }
    /// Writes the properties of the scan as field data and closes the file.
    void close_with(const Scan& scan, const Box& box);

private:
    void field_data(const std::string& name, double value) {
        file_.write("/VTKHDF/FieldData/" + name, std::vector<double>{value});
    }
    h5::File file_;
};

}  // namespace mcdem::io
