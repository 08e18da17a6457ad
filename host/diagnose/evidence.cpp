#include "diagnose/evidence.h"

#include <algorithm>
#include <stdexcept>

namespace mcdem {
namespace {

const Signature& find(const std::vector<Signature>& list, const std::string& name) {
    const auto found = std::ranges::find(list, name, &Signature::name);
    if (found == list.end()) throw std::logic_error("no signature of " + name);
    return *found;
}

/// How far beyond its prior a parameter is followed, in sigmas.
constexpr double farthest = 12;

/// Mean over the rows that are finite.
Eigen::VectorXd column_means(const Eigen::MatrixXd& rows) {
    Eigen::VectorXd mean(rows.cols());
    for (Eigen::Index cell = 0; cell < rows.cols(); ++cell) {
        const auto column = rows.col(cell).array();
        mean[cell] =
            column.isFinite().select(column, 0).sum() / static_cast<double>(column.isFinite().count());
    }
    return mean;
}

/// Replicates of one packing know of one another through their mean: they are left out together where there
/// are packings enough.
std::vector<int> folds_of(const std::vector<int>& packing) {
    constexpr int most = 8;
    const int packings = 1 + *std::ranges::max_element(packing);
    std::vector<int> fold;
    for (std::size_t r = 0; r < packing.size(); ++r)
        fold.push_back((packings >= most ? packing[r] : static_cast<int>(r)) % most);
    return fold;
}

}  // namespace

GapData gap_data(const Evidence& evidence) {
    GapData s;
    s.mean = column_means(evidence.baseline);
    s.gap = evidence.observed - s.mean;
    s.cells = usable_cells(evidence.library, s.gap);
    s.noise = scatter(evidence.library);
    s.fold = folds_of(evidence.library.packing);
    for (const NuisancePrior& prior : evidence.nuisances)
        s.free.push_back({find(evidence.library.nuisances, prior.name).linear, prior.sigma});
    for (const CandidateRange& range : evidence.candidates)
        s.candidates.push_back({&find(evidence.library.effects, range.name), range.low, range.high});
    s.effects = static_cast<int>(s.candidates.size());
    for (const NuisancePrior& prior : evidence.nuisances)
        if (prior.name == "modulus" || prior.name == "strain_offset" || prior.name == "gamma")
            s.candidates.push_back({&find(evidence.library.nuisances, prior.name), -farthest * prior.sigma,
                                    farthest * prior.sigma});
    return s;
}

}  // namespace mcdem
