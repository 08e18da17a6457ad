// Evidence without simulations: normal noise of known covariance on a few observables, and given signatures.
#pragma once
#include <utility>

#include "diagnose/infer/evidence.h"
#include "metrics/estimate.h"
#include "scene/random.h"

namespace mcdem {

inline const Grid synthetic_grid{{0.0126, 0.0183, 0.0240, 0.0294}, 0.0036, 0.03};

/// Cells of the first `observables_known` observables have values; the noise of adjacent cells is
/// correlated.
class SyntheticWorld {
public:
    SyntheticWorld(int observables_known, std::uint64_t seed)
        : cells_(static_cast<Eigen::Index>(cells_of(synthetic_grid).size())),
          known_(8 * observables_known),
          random_(seed, Stream::positions) {}

    Eigen::Index known() const { return known_; }
    Random& random() { return random_; }

    /// Variance 1, correlation 1/2 between adjacent cells; NaN for unknown cells.
    Eigen::VectorXd noise(double size = 1) {
        Eigen::VectorXd values = Eigen::VectorXd::Constant(cells_, not_available);
        for (Eigen::Index cell = 0; cell < known_; ++cell)
            values[cell] =
                cell == 0 ? random_.normal() : 0.5 * values[cell - 1] + std::sqrt(0.75) * random_.normal();
        return size * values;
    }

    /// `size` at each cell, with random signs.
    Eigen::VectorXd pattern(double size) {
        Eigen::VectorXd values = Eigen::VectorXd::Zero(cells_);
        for (Eigen::Index cell = 0; cell < known_; ++cell)
            values[cell] = random_.uniform() < 0.5 ? -size : size;
        return values;
    }

    Signature signature(const std::string& name, const Eigen::VectorXd& linear) const {
        const Eigen::VectorXd zero = Eigen::VectorXd::Zero(cells_);
        return {name, 10, linear, zero, linear.transpose().replicate(8, 1)};
    }

    /// Replicates of packings that differ by `packing_scatter`. The last packing is that of the experiment;
    /// its replicates are the baseline, and the observation is one more of them. No candidates.
    Evidence evidence(int packings, int replicates, double packing_scatter = 3) {
        Evidence evidence;
        evidence.library.grid = synthetic_grid;
        evidence.library.baseline.resize(packings * replicates, cells_);
        for (int p = 0; p < packings; ++p) {
            const Eigen::VectorXd centre = noise(packing_scatter);
            for (int r = 0; r < replicates; ++r) {
                evidence.library.baseline.row(p * replicates + r) = (centre + noise()).transpose();
                evidence.library.packing.push_back(p);
            }
            evidence.observed = centre + noise();
        }
        evidence.baseline = evidence.library.baseline.bottomRows(replicates);
        return evidence;
    }

    void add_effect(Evidence& evidence, const std::string& name, const Eigen::VectorXd& linear,
                    double low = -10, double high = 10) const {
        evidence.library.effects.push_back(signature(name, linear));
        evidence.candidates.push_back({name, "", low, high});
    }

    void add_nuisance(Evidence& evidence, const std::string& name, const Eigen::VectorXd& linear,
                      double sigma) const {
        evidence.library.nuisances.push_back(signature(name, linear));
        evidence.nuisances.push_back({name, "", sigma});
    }

private:
    Eigen::Index cells_, known_;
    Random random_;
};

/// Two effects of which the first is the cause, and a parameter.
struct TwoEffects {
    TwoEffects() {
        synthetic.add_effect(evidence, "adhesion", synthetic.pattern(1));
        synthetic.add_effect(evidence, "friction", synthetic.pattern(1));
        synthetic.add_nuisance(evidence, "modulus", synthetic.pattern(0.5), 1);
        evidence.observed += 4 * evidence.library.effects[0].linear;
    }
    SyntheticWorld synthetic{6, 3};
    Evidence evidence = synthetic.evidence(1, 16);
};

}  // namespace mcdem
