#include "diagnose/observe/overlap_regression.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/container.h"
#include "core/least_squares.h"
#include "core/near_pairs.h"

namespace mcdem::inline diagnose {
namespace {

/// Smaller overlaps are not significant compared with errors of positions.
constexpr double clear_overlap = 0.02;

template <int terms>
using Terms = Eigen::Matrix<double, terms, 1>;

/// Least squares, accumulated contact by contact.
template <int terms>
class Regression {
public:
    void add(const Terms<terms>& x, double y) {
        products_.noalias() += x * x.transpose();
        right_ += x * y;
        ++rows_;
    }
    /// NaN with fewer than five rows per term.
    Terms<terms> solve() const {
        if (rows_ < 5 * terms) return Terms<terms>::Constant(unknown);
        return least_squares(products_, right_);
    }

private:
    Eigen::Matrix<double, terms, terms> products_ = Eigen::Matrix<double, terms, terms>::Zero();
    Terms<terms> right_ = Terms<terms>::Zero();
    int rows_ = 0;
};

Terms<4> grain_terms(const ContactResidual& c) {
    return {1, c.implied, c.implied * c.implied, c.cross_contact};
}

/// Mean product of the residuals of two contacts of one grain, and the same with residual times overlap.
std::array<double, 2> shared_remainders(std::size_t grains, std::span<const ContactResidual> contacts,
                                        const std::vector<double>& remainder, double mean_overlap) {
    struct Sums {
        double r = 0, rr = 0, q = 0, qq = 0;
        int n = 0;
    };
    std::vector<Sums> of(grains);
    for (std::size_t k = 0; k < contacts.size(); ++k) {
        if (is_wall(contacts[k].partner)) continue;
        const double q = remainder[k] * (contacts[k].implied / mean_overlap - 1);
        for (const int grain : {contacts[k].grain, contacts[k].partner}) {
            Sums& s = of[grain];
            s.r += remainder[k];
            s.rr += remainder[k] * remainder[k];
            s.q += q;
            s.qq += q * q;
            ++s.n;
        }
    }
    double products = 0, scaled = 0, pairs = 0;
    for (const Sums& s : of) {
        products += s.r * s.r - s.rr;
        scaled += s.q * s.q - s.qq;
        pairs += s.n * (s.n - 1);
    }
    if (!(pairs > 0)) return {unknown, unknown};
    const auto signed_root = [](double x) { return std::copysign(std::sqrt(std::abs(x)), x); };
    return {signed_root(products / pairs), signed_root(scaled / pairs)};
}

double root_mean_square(const std::vector<double>& values) {
    double sum = 0;
    int n = 0;
    for (const double value : values)
        if (std::isfinite(value)) sum += value * value, ++n;
    return n ? std::sqrt(sum / n) : unknown;
}

}  // namespace

std::array<double, 2> contact_occurrence(const Recording& recording, const Scan& scan,
                                         std::span<const ContactResidual> contacts) {
    const double grains = static_cast<double>(recording.diameter.size());
    std::vector<std::pair<int, int>> listed;
    double gaps = 0;
    for (const ContactResidual& c : contacts) {
        if (is_wall(c.partner)) continue;
        listed.push_back(std::minmax(c.grain, c.partner));
        gaps += c.measured < 0 ? 1 : 0;
    }
    std::ranges::sort(listed);
    double silent = 0;
    const double largest = *std::ranges::max_element(recording.diameter);
    NeighbourGrid(scan.position, recording.box, scan.plate_z, largest).for_each_pair([&](int i, int j) {
        const double a = recording.diameter[i];
        const double b = recording.diameter[j];
        const double reach = 0.5 * (a + b) - clear_overlap * 0.5 * a * b / (a + b);
        const Vec3 between = apart(recording.box, scan.position[i], scan.position[j]);
        if (between.squaredNorm() < reach * reach)
            silent += !std::ranges::binary_search(listed, std::pair<int, int>(std::minmax(i, j)));
    });
    return {gaps / grains, silent / grains};
}

std::array<double, 7> grain_overlaps(const Recording& recording, std::span<const ContactResidual> contacts) {
    Regression<4> regression;
    double overlaps = 0, number = 0;
    for (const ContactResidual& c : contacts) {
        if (is_wall(c.partner)) continue;
        regression.add(grain_terms(c), c.residual());
        overlaps += std::abs(c.implied);  // contacts that pull have negative ones
        ++number;
    }
    const Terms<4> fit = regression.solve();
    std::vector<double> remainder(contacts.size(), unknown);
    for (std::size_t k = 0; k < contacts.size(); ++k)
        if (!is_wall(contacts[k].partner))
            remainder[k] = contacts[k].residual() - fit.dot(grain_terms(contacts[k]));
    const auto shared = shared_remainders(recording.diameter.size(), contacts, remainder, overlaps / number);
    return {fit[0], fit[1], fit[2], fit[3], root_mean_square(remainder), shared[0], shared[1]};
}

std::array<double, 6> wall_overlaps(const Recording& recording, const Scan& scan,
                                    std::span<const ContactResidual> contacts) {
    Regression<2> sides;
    Regression<1> floor;
    Regression<3> plate;
    for (const ContactResidual& c : contacts) {
        if (!is_wall(c.partner)) continue;
        const double y = c.residual() - c.cross_contact;
        const Vec3& at = scan.position[c.grain];
        switch (wall_of(c.partner)) {
            case Wall::floor:
                floor.add(Terms<1>(1), y);
                break;
            case Wall::plate:
                plate.add({1, 2 * at.x() / recording.box.size_x - 1, 2 * at.y() / recording.box.size_y - 1},
                          y);
                break;
            default:
                sides.add({1, c.implied}, y);
        }
    }
    const auto side = sides.solve();
    const auto top = plate.solve();
    return {side[0], side[1], floor.solve()[0], top[0], top[1], top[2]};
}

}  // namespace mcdem::diagnose
