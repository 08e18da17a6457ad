// Recommended next measurements, predicted from the signatures.
#pragma once
#include "diagnose/decide/decision.h"
#include "diagnose/infer/gap_tests.h"

namespace mcdem::inline diagnose {

/// Useful measurements, best first. If several effects explain the gap: with the probability that they
/// distinguish the leading effect from its nearest rival; otherwise with the resulting errors of amplitudes
/// or detection limits.
std::vector<NextStep> next_measurements(const Evidence& evidence, const GapData& data,
                                        const Findings& findings, const Decision& decision,
                                        const Limits& limits);

/// To check the parameters of Diagnosis::check_first; nothing if there are none.
std::optional<NextStep> check_of(const Diagnosis& diagnosis);

/// The proposal of the nearest rival of the leading effect, if it was confirmed by runs too.
std::optional<std::size_t> proposal_of_rival(const Findings& findings, const Decision& decision);

/// Runs of the leading effect and of its rival under another protocol of the plate. Row: replicate, with the
/// same packing and noise in both; column: cell.
struct ProtocolRuns {
    Eigen::MatrixXd leader, rival;
};

/// Probability that one experiment under this protocol distinguishes the two. Noise and parameters are those
/// of the diagnosis. A cell that only the protocol has, such as the relaxation in a hold, has the scatter of
/// the runs and depends on no parameter.
double power_of_protocol(const ProtocolRuns& runs, const Evidence& evidence, const GapData& data,
                         const Findings& findings, const Decision& decision, const Limits& limits);

}  // namespace mcdem::diagnose
