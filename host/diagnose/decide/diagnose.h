// From evidence to diagnosis: detection limits, existence and location of the gap, effects, and gap
// reduction.
#pragma once

#include "diagnose/decide/decision.h"
#include "diagnose/decide/next_steps.h"
#include "diagnose/infer/gap_reduction.h"

namespace mcdem::inline diagnose {

/// Builds a diagnosis step by step. The evidence must outlive it.
///     DiagnosisBuilder builder(evidence, limits);
///     for (k ..) builder.confirm(k, runs of builder.whole_fit(k));   // real runs of the proposals, optional
///     while (builder.refit(..)) ..                                 // again with corrected parameters
///     while (k = builder.wants_held_out()) builder.confirm_held_out(k, runs of builder.part_fit(k));
///     builder.diagnosis()
class DiagnosisBuilder {
public:
    /// Throws InputError if observation and library have too few common cells.
    DiagnosisBuilder(const Evidence& evidence, const Limits& limits);

    const GapData& data() const { return data_; }
    const Findings& findings() const { return findings_; }
    const Decision& decision() const { return decision_; }

    /// Parameters of proposal k fitted to all data; after refit() corrected by the last runs.
    const PartialFit& whole_fit(std::size_t proposal) const { return whole_[proposal]; }
    /// Adds real runs with whole_fit(); one row per replicate.
    void confirm(std::size_t proposal, const Eigen::MatrixXd& runs);
    /// Corrects the parameters of a confirmed proposal by one Gauss-Newton step if its runs leave a gap, or
    /// if a nuisance can gain by it. Returns false if nothing can be gained.
    bool refit(std::size_t proposal);

    /// The next proposal that needs runs with part_fit(), because the verdict depends on how much of the
    /// held-out gap they take away.
    std::optional<std::size_t> wants_held_out() const;
    /// Parameters of proposal k fitted to the data that are not held out, from its real runs if there are
    /// any.
    PartialFit part_fit(std::size_t proposal) const;
    void confirm_held_out(std::size_t proposal, const Eigen::MatrixXd& runs);
    /// Whether there is a gap and the verdict refers to a proposal.
    bool has_decided() const { return decision_.verdict != Verdict::no_gap && decision_.proposal >= 0; }
    std::size_t decided() const { return static_cast<std::size_t>(decision_.proposal); }

    /// Factor by which a numerical setting must be refined, a power of two or at most `most`, so that the
    /// remaining change up to the fitted amplitude, from its signature, is not detectable.
    double refining_factor(std::size_t candidate, double most) const;

    /// Power of another protocol to distinguish the leading effect from its rival.
    double power_of(const ProtocolRuns& runs) const {
        return power_of_protocol(runs, evidence_, data_, findings_, decision_, limits_);
    }

    Diagnosis diagnosis() const;

private:
    /// Whether a nuisance that does not lead may still gain according to its runs: it gets every chance
    /// before an effect is named.
    bool may_gain(std::size_t proposal) const;
    /// Computes the reductions of all proposals and of a placebo from signatures.
    void measure_reductions();
    /// Shifts of the nuisances that the explanation of a proposal needs besides its effects.
    Eigen::VectorXd shifts_of(std::size_t proposal) const;
    std::vector<NuisanceFit> check_first() const;
    /// Whether the reduction is measured by likelihood: nuisances refitted within their priors leave no gap
    /// to measure otherwise.
    bool by_likelihood(const Proposal& proposal) const;
    double likelihood_reduction(double gain) const;
    /// Without the place that is left out for this proposal.
    Split split_of(const Proposal& proposal) const;

    const Evidence& evidence_;
    Limits limits_;
    GapData data_;
    int mean_of_;  ///< number of replicates in the baseline's mean
    GapSpace space_;
    NullDistribution null_;
    std::vector<PlaceLeftOut> places_;  ///< if there is a gap
    GapStatistics statistics_;
    Findings findings_;
    Decision decision_;
    std::vector<PartialFit> whole_;
    std::vector<std::optional<Eigen::VectorXd>>
        step_;  ///< by proposal: next step of nuisances, then amplitudes
    /// The last runs of a proposal, and their parameters.
    struct Runs {
        PartialFit fit;
        Eigen::VectorXd mean;
        int count = 0;
    };
    std::vector<std::optional<Runs>> runs_;  ///< by proposal
    std::vector<bool> held_out_done_;        ///< by proposal
    Split split_;
    double excess_ = 0;  ///< gain in log likelihood if the whole gap were explained
};

}  // namespace mcdem::diagnose
