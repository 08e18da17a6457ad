// The metrics of curves that another code computed for the authors' packing.
#include <fstream>
#include <sstream>

#include "authors_data.h"
#include "metrics/compare.h"

namespace mcdem {
namespace {

Recording curve(const std::filesystem::path& file) {
    Recording made;
    std::ifstream in(file);
    std::string line, phase, displacement, force;
    std::getline(in, line);
    while (std::getline(in, line)) {
        std::istringstream fields(line);
        std::getline(fields, phase, ',');
        std::getline(fields, displacement, ',');
        std::getline(fields, force, ',');
        Scan scan;
        scan.phase = phase == "load" ? Phase::load : Phase::unload;
        scan.plate_z = -1e-3 * std::stod(displacement);
        scan.wall_force[static_cast<int>(Wall::plate)].z() = std::stod(force);
        scan.coordination_number = not_available;
        made.scans.push_back(scan);
    }
    return made;
}

TEST(OtherCode, ratio_of_its_peaks_is_known) {
    SKIP_WITHOUT_AUTHORS_DATA("liggghts_hertz.csv");
    SKIP_WITHOUT_AUTHORS_DATA("liggghts_half_space_gamma_1.csv");
    const auto hertz = curve(reference::authors_folder / "liggghts_hertz.csv");
    const auto half_space = curve(reference::authors_folder / "liggghts_half_space_gamma_1.csv");
    const auto c = compare({"hertz", {&hertz}}, {&half_space});
    EXPECT_NEAR(c.Rtop.value, 6.69 / 13.29, 0.005);
    EXPECT_EQ(c.levels_errf, c.reference_levels);
    EXPECT_GT(c.errf.value, 1);
    EXPECT_FALSE(c.errZ.available());
}

}  // namespace
}  // namespace mcdem
