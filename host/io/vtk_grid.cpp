#include "io/vtk_grid.h"

#include <numeric>

#include "core/container.h"

namespace mcdem::inline io {

void VtkCells::add(VtkCell type, const std::vector<Vec3>& corners) {
    for (const Vec3& corner : corners) points.insert(points.end(), corner.data(), corner.data() + 3);
    offsets.push_back(static_cast<long>(points.size() / 3));
    types.push_back(static_cast<unsigned char>(type));
}

VtkGrid::VtkGrid(NewFile& out, const VtkCells& cells) : file_(h5::File::create(out)) {
    const long points = static_cast<long>(cells.points.size() / 3);
    file_.make_group("/VTKHDF");
    file_.set_attribute("/VTKHDF", "Version", std::vector<long>{1, 0});
    file_.set_attribute("/VTKHDF", "Type", std::string_view("UnstructuredGrid"));
    file_.write("/VTKHDF/NumberOfPoints", std::vector<long>{points});
    file_.write("/VTKHDF/NumberOfCells", std::vector<long>{static_cast<long>(cells.types.size())});
    file_.write("/VTKHDF/NumberOfConnectivityIds", std::vector<long>{points});
    file_.write("/VTKHDF/Points", cells.points, {3});
    std::vector<long> connectivity(static_cast<std::size_t>(points));
    std::iota(connectivity.begin(), connectivity.end(), 0L);
    file_.write("/VTKHDF/Connectivity", connectivity);
    file_.write("/VTKHDF/Offsets", cells.offsets);
    file_.write("/VTKHDF/Types", cells.types);
    for (const char* group : {"/VTKHDF/PointData", "/VTKHDF/CellData", "/VTKHDF/FieldData"})
        file_.make_group(group);
}

void VtkGrid::close_with(const Scan& scan, const Box& box) {
    field_data("frame", scan.frame);
    field_data("time", scan.time);
    field_data("plate_z", scan.plate_z);
    field_data("top_force", scan.top_force());
    if (is_cell(box)) {
        const char* const names[]{"strain_x", "strain_y", "strain_z", "shear_xy", "shear_xz", "shear_yz"};
        for (std::size_t k = 0; k < scan.strain.size(); ++k) field_data(names[k], scan.strain[k]);
    }
    file_.close();
}

}  // namespace mcdem::io
