#include "diagnose/decide/packings.h"

#include <cmath>

namespace mcdem::inline diagnose {
namespace {

/// The only parameter that can differ between packings: the zero of strain. All others belong to the
/// material.
std::vector<FreeParameter> own_parameters(const Evidence& evidence, const GapData& data, double scale) {
    std::vector<FreeParameter> own;
    for (std::size_t k = 0; k < data.free.size(); ++k)
        if (evidence.nuisances[k].name == "strain_offset")
            own.push_back({data.free[k].direction, scale * data.free[k].sigma});
    return own;
}

}  // namespace

std::vector<PackingAgreement> packing_agreements(const Evidence& evidence, const GapData& data,
                                                 const NullDistribution& null, const Proposal* decided,
                                                 const Limits& limits) {
    const double count = evidence.packing_count();
    if (count < 2) return {};
    const int mean_of = static_cast<int>(evidence.baseline.rows());
    const Eigen::MatrixXd noise = std::sqrt(count) * data.noise;  // for one packing
    const double apart =
        std::sqrt(1 - 1 / count);  // for the difference between one packing and the mean of all
    const GapSpace alone(noise, mean_of, data.cells, data.free);
    Eigen::VectorXd extra;  // effects vary slightly between packings
    if (decided) extra = apart * apart * signature_variance(data, *decided);
    const GapSpace differences(apart * noise, mean_of, data.cells, own_parameters(evidence, data, apart),
                               extra);
    const auto p_of = [&](const GapSpace& space, const Eigen::VectorXd& gap) {
        return null.p_value(&GapStatistics::omnibus, space.whiten(gap).squaredNorm());
    };
    std::vector<PackingAgreement> list;
    for (const PackingEvidence& packing : evidence.packings) {
        const Eigen::VectorXd gap = packing.gap();
        PackingAgreement& one = list.emplace_back();
        one.experiment = packing.name;
        one.gap_p = p_of(alone, gap);
        one.agreement_p = p_of(differences, gap - data.gap);
        one.differs = one.agreement_p < limits.false_alarm / count;
        if (!decided) continue;
        const EffectFit fit = fit_effect(alone, data.candidates[decided->candidates.front()], gap);
        one.amplitude = fit.amplitude;
        one.amplitude_error = fit.error;
    }
    return list;
}

}  // namespace mcdem::diagnose
