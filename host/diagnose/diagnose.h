// From evidence to verdict: what can be told, whether there is a gap, where, which effect, how far it
// shrinks.
#pragma once
#include <memory>

#include "diagnose/decision.h"
#include "diagnose/shrinkage.h"

namespace mcdem {

/// A diagnosis in the making. The evidence must outlive it.
///     Draft draft(evidence, limits);
///     for (k ..) draft.confirm(k, runs of draft.whole_fit(k));   // real runs of the proposals, or none
///     while (draft.refit(..)) ..                                 // again, where the runs say how they miss
///     if (draft.wants_held_out()) draft.confirm_held_out(runs of draft.part_fit());
///     draft.diagnosis()
class Draft {
public:
    /// Throws InputError where the observation shares too few cells with the library.
    Draft(const Evidence& evidence, const Limits& limits);

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

    bool wants_held_out() const { return decision_.verdict != Verdict::no_gap && decision_.proposal >= 0; }
    /// The same for the proposal decided on, fitted on the part that is not held out.
    PartialFit part_fit() const;
    const Proposal& decided() const {
        return findings_.proposals[static_cast<std::size_t>(decision_.proposal)];
    }
    void confirm_held_out(const Eigen::MatrixXd& runs);

    Diagnosis diagnosis() const;

private:
    /// A nuisance that does not lead although runs ask for more of it: it is to have every chance before an
    /// effect is named.
    bool may_gain(std::size_t proposal) const;

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
    std::optional<Eigen::MatrixXd> held_out_runs_;
};

}  // namespace mcdem
