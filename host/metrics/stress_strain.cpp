#include "metrics/stress_strain.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/container.h"

namespace mcdem::inline metrics {

double mean_stress(const Mat3& stress) { return stress.trace() / 3; }

double deviatoric_stress(const Mat3& stress) {
    const Mat3 symmetric = (stress + stress.transpose()) / 2;
    return std::sqrt(1.5) * (symmetric - mean_stress(stress) * Mat3::Identity()).norm();
}

double volume_strain(const Strain& strain) { return 1 - deformation(strain).determinant(); }

double deviatoric_strain(const Strain& strain) {
    const Mat3 f = deformation(strain);
    const Eigen::SelfAdjointEigenSolver<Mat3> stretches(f * f.transpose(), Eigen::EigenvaluesOnly);
    const Vec3 logarithmic = stretches.eigenvalues().array().log() / 2;
    return std::sqrt(2.0 / 3) * (logarithmic.array() - logarithmic.mean()).matrix().norm();
}

double load(const Recording& recording, const Scan& scan) {
    return is_cell(recording.box) ? mean_stress(scan.stress) : scan.top_force();
}

std::optional<std::size_t> strongest_scan(const Recording& recording) {
    std::optional<std::size_t> strongest;
    double largest = 0;
    for (std::size_t s = 0; s < recording.scans.size(); ++s)
        if (const double here = load(recording, recording.scans[s]); here > largest) {
            largest = here;
            strongest = s;
        }
    return strongest;
}

}  // namespace mcdem::metrics
