// Everything that a diagnosis rests on, as numbers: no simulator and no files behind it.
#pragma once
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "diagnose/infer/effect_fit.h"
#include "diagnose/infer/gap_space.h"

namespace mcdem::inline diagnose {

/// An effect that may be to blame, with plausible amplitudes.
struct CandidateRange {
    std::string name, unit;
    double low = 0, high = 0;
};
/// A parameter that may be off, with its prior.
struct NuisancePrior {
    std::string name, unit;
    double sigma = 0;
};

/// One of several packings of an experiment: what was seen of it, and runs of the scene on it.
struct PackingEvidence {
    std::string name;
    Eigen::VectorXd observed;
    Eigen::MatrixXd baseline;
    /// Observed less the mean of the baseline.
    Eigen::VectorXd gap() const;
};

struct Evidence {
    Eigen::VectorXd observed;  ///< the experiment, one entry a cell
    Eigen::MatrixXd baseline;  ///< row: replicate of the scene on the experiment's packing
    Library library;
    std::vector<CandidateRange> candidates;  ///< all of them in library.effects
    std::vector<NuisancePrior> nuisances;    ///< all of them in library.nuisances
    std::uint64_t seed = 1;                  ///< of everything drawn at random
    /// Several packings: observed and baseline are their means (take_means). Empty: one.
    std::vector<PackingEvidence> packings = {};
    int packing_count() const { return std::max(1, static_cast<int>(packings.size())); }
};

/// Observed and baseline as the means over the packings. Where noise and signatures are alike the mean of the
/// gaps holds all that the packings say of what they share: its likelihood is the product of theirs.
void take_means(Evidence& evidence);

/// Mean over packings whose rows lie one packing after the other.
Eigen::MatrixXd mean_over_packings(const Eigen::MatrixXd& rows, int packings);

/// Leaves out what simulations failed to give: replicates without any number, candidates and nuisances
/// without a signature in most of the cells that are known otherwise. Says what, and why. Throws InputError
/// where too few replicates are left.
std::vector<std::string> leave_out_failures(Evidence& evidence);

/// The evidence on chosen cells, with everything that follows from it before the observed is looked at.
struct GapData {
    CellChoice cells;
    Eigen::VectorXd mean;    ///< of the baseline
    Eigen::VectorXd gap;     ///< observed less mean
    Eigen::MatrixXd noise;   ///< scatter of one replicate, of several packings of their mean
    std::vector<int> group;  ///< by row of noise: rows with a mean in common (library.h)
    std::vector<int> fold;   ///< by row of noise: rows that are left out together, those of one packing
    std::vector<FreeParameter> free;
    std::vector<Candidate> candidates;  ///< effects, then nuisances beyond their priors
    int effects = 0;                    ///< how many of them are effects
    int packings = 1;                   ///< behind the gap
    const std::string& name(std::size_t candidate) const { return candidates[candidate].signature->name; }
};

/// Views into `evidence`, which must stay.
GapData gap_data(const Evidence& evidence);

}  // namespace mcdem::diagnose
