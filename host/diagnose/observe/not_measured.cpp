#include "diagnose/observe/not_measured.h"

#include <cmath>
#include <set>

namespace mcdem::inline diagnose {

std::vector<std::string> not_measured(const Eigen::VectorXd& observed, const Grid& grid) {
    std::set<Needs> seen;
    const auto cells = cells_of(grid);
    for (std::size_t k = 0; k < cells.size(); ++k)
        if (std::isfinite(observed[static_cast<Eigen::Index>(k)]))
            seen.insert(observables()[static_cast<std::size_t>(cells[k].observable)].needs);
    std::vector<std::string> texts;
    if (!seen.count(Needs::contacts))
        texts.push_back(
            "contacts.csv: the forces of contacts would tell the force distribution, the floor's and the "
            "walls' share, the "
            "plate's couple and biases of the force measurement");
    if (!seen.count(Needs::positions))
        texts.push_back(
            "grains.csv beyond frame 0, with contacts.csv: positions would tell the overlaps that the forces "
            "should imply, "
            "hence cross-contact effects, stiffening, adhesion, friction and errors of sizes");
    return texts;
}

}  // namespace mcdem::diagnose
