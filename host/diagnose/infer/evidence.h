// All numbers that a diagnosis is based on, without simulator and files.
#pragma once
#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "diagnose/decide/diagnosis.h"
#include "diagnose/infer/effect_fit.h"
#include "diagnose/infer/gap_space.h"

namespace mcdem::inline diagnose {

/// A candidate effect with its range of plausible amplitudes.
struct CandidateRange {
    std::string name, unit;
    double low = 0, high = 0;
};
/// An uncertain parameter with its prior.
struct NuisancePrior {
    std::string name, unit;
    double sigma = 0;
};

/// One of several packings of an experiment: its observation, and runs of the scene on it.
struct PackingEvidence {
    std::string name;
    Eigen::VectorXd observed;
    Eigen::MatrixXd baseline;
    /// Observed minus the mean of the baseline.
    Eigen::VectorXd gap() const;
};

struct Evidence {
    Eigen::VectorXd observed;             ///< the experiment, one entry per cell
    Eigen::MatrixXd baseline;             ///< row: replicate of the scene on the experiment's packing
    Eigen::MatrixXd finer_baseline = {};  ///< the same with half the error of positions; may be empty
    Library library;
    std::vector<CandidateRange> candidates;  ///< all of library.effects
    std::vector<NuisancePrior> nuisances;    ///< all of library.nuisances
    std::uint64_t seed = 1;                  ///< for all random draws
    bool library_is_own = true;              ///< made on the experiment's own packings
    /// For several packings, whose means (take_means) are observed and baseline. Empty: a single packing.
    std::vector<PackingEvidence> packings = {};
    int packing_count() const { return std::max(1, static_cast<int>(packings.size())); }
};

/// Sets observed and baseline to the means over the packings. If noise and signatures are equal, the mean of
/// the gaps contains all information about what the packings share: its likelihood is the product of theirs.
void take_means(Evidence& evidence);

/// Mean over packings whose rows are stored one packing after the other.
Eigen::MatrixXd mean_over_packings(const Eigen::MatrixXd& rows, int packings);

/// Why simulations failed, by candidate or nuisance; empty name: the unchanged scene.
using FailureCauses = std::map<std::string, std::string>;

/// Leaves out the results of failed simulations: replicates without any value, candidates and nuisances
/// without a signature in most of the otherwise known cells. Replicates without values in some cells are left
/// out of the noise if more values remain so. Returns what was left out and why. Throws InputError if too few
/// replicates remain.
std::vector<std::string> leave_out_failures(Evidence& evidence, const FailureCauses& causes = {});

/// Group of the replicates of the experiment's own packing if the library is made on other packings.
constexpr int own_packing = -1;

/// The evidence on selected cells, with all derived quantities that do not depend on the observation.
struct GapData {
    CellChoice cells;
    Eigen::VectorXd mean;    ///< of the baseline
    Eigen::VectorXd gap;     ///< observed minus mean
    Eigen::MatrixXd noise;   ///< scatter of one replicate; for several packings, of their mean
    std::vector<int> group;  ///< by row of noise: rows with a common mean (library.h)
    std::vector<int> fold;   ///< by row of noise: rows that are left out together, those of one packing
    std::vector<FreeParameter> free;
    std::vector<Candidate> candidates;  ///< effects, then nuisances beyond their priors
    int effects = 0;                    ///< number of effects among them
    int packings = 1;                   ///< number of packings in the gap
    std::vector<MissingBins> missing;   ///< what lacks cells that the experiment has
    /// Copies of signatures that lack cells, with zeros there.
    std::vector<std::shared_ptr<const Signature>> completed;
    /// Cells that one of these candidates lacks.
    CellChoice lacking(const std::vector<std::size_t>& chosen) const;
    const std::string& name(std::size_t candidate) const { return candidates[candidate].signature->name; }
    /// The nuisances, each limited to the range in which simulations are made. A fit far from the data may
    /// leave it, and a modulus is an exponential of its nuisance.
    Eigen::VectorXd in_range(Eigen::VectorXd nuisances) const;
    static bool at_end_of_range(double nuisance, double sigma);
};

/// The signatures of the evidence's nuisances.
std::vector<const Signature*> parameters_of(const Evidence& evidence);

/// Holds references to `evidence`, which must outlive it.
GapData gap_data(const Evidence& evidence);

}  // namespace mcdem::diagnose
