#include "diagnose/observe/compared_forces.h"

namespace mcdem::inline diagnose {

ComparedForces compared_forces(const Recording& recording) {
    Recording plate;
    plate.plate_start = recording.plate_start;
    plate.parameters = recording.parameters;
    for (const Scan& scan : recording.scans) {
        Scan& one = plate.scans.emplace_back(scan);
        one.position.clear();
        one.contacts.clear();
    }
    const Grid grid = grid_of(plate);
    return {grid.displacement, static_cast<std::size_t>(observe(plate, grid, {}).array().isFinite().count())};
}

}  // namespace mcdem::diagnose
