// From evidence to verdict: what can be told, whether there is a gap, where, which effect, how far it
// shrinks.
#pragma once
#include <memory>

#include "diagnose/decide/decision.h"
#include "diagnose/infer/gap_reduction.h"

namespace mcdem::inline diagnose {

/// A diagnosis in the making. The evidence must outlive it.
///     DiagnosisBuilder draft(evidence, limits);
///     for (k ..) draft.confirm(k, runs of draft.whole_fit(k));   // real runs of the proposals, or none
///     while (draft.refit(..)) ..                                 // again, where the runs say how they miss
///     while (k = draft.wants_held_out()) draft.confirm_held_out(k, runs of draft.part_fit(k));
///     draft.diagnosis()
class DiagnosisBuilder {
public:
    /// Throws InputError where the observation shares too few cells with the library.
    DiagnosisBuilder(const Evidence& evidence, const Limits& limits);

    const GapData& data() const { return data_; }
    const Findings& findings() const { return findings_; }
    const Decision& decision() const { return decision_; }

    /// What proposal k says the parameters are, fitted on everything; after refit() what the last runs say.
    const PartialFit& whole_fit(std::size_t proposal) const { return whole_[proposal]; }
    /// Real runs with whole_fit(); row: replicate.
    void confirm(std::size_t proposal, const Eigen::MatrixXd& runs);
    /// Moves the parameters of a confirmed proposal by what its runs leave (a step of Gauss and Newton's
    /// method) where they leave a gap of their own, or where a nuisance may gain by it. False where there is
    /// nothing to gain.
    bool refit(std::size_t proposal);

    /// The next proposal whose runs with part_fit() the verdict waits for: it hangs on how much of the gap on
    /// data held out they take away.
    std::optional<std::size_t> wants_held_out() const;
    /// What proposal k says the parameters are, fitted on the part that is not held out, by its real runs
    /// where there were any.
    PartialFit part_fit(std::size_t proposal) const;
    void confirm_held_out(std::size_t proposal, const Eigen::MatrixXd& runs);
    /// Whether there is a gap, and a proposal that the verdict is about.
    bool has_decided() const { return decision_.verdict != Verdict::no_gap && decision_.proposal >= 0; }
    std::size_t decided() const { return static_cast<std::size_t>(decision_.proposal); }

    /// By how many times a setting of the numerics is to be refined, `most` times at most (else a power of
    /// two), until what its signature still changes up to the fitted reality would not be noticed.
    double refining_factor(std::size_t candidate, double most) const;

    Diagnosis diagnosis() const;

private:
    /// A nuisance that does not lead although runs ask for more of it: it is to have every chance before an
    /// effect is named.
    bool may_gain(std::size_t proposal) const;
    /// Reductions of all proposals by the signatures, and that of a placebo.
    void measure_reductions();
    /// .. by a gain in likelihood; nuisances refitted within their priors leave no gap to measure otherwise.
    bool by_likelihood(const Proposal& proposal) const;
    double likelihood_reduction(double gain) const;

    const Evidence& evidence_;
    Limits limits_;
    GapData data_;
    int mean_of_;  ///< replicates behind the baseline's mean
    GapSpace space_;
    NullDistribution null_;
    GapStatistics statistics_;
    Findings findings_;
    Decision decision_;
    std::vector<PartialFit> whole_;
    std::vector<std::optional<Eigen::VectorXd>> step_;  ///< by proposal: of nuisances, then amplitudes
    /// The last runs of a proposal, and what they were made with.
    struct Runs {
        PartialFit fit;
        Eigen::VectorXd mean;
        int count = 0;
    };
    std::vector<std::optional<Runs>> runs_;  ///< by proposal
    std::vector<bool> held_out_done_;        ///< by proposal
    Split split_;
    double excess_ = 0;  ///< what the whole gap would gain in log likelihood
};

}  // namespace mcdem::diagnose
