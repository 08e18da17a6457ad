// Simulates the cases of a challenge with all their hidden effects.
#pragma once
#include <functional>
#include <span>

#include "challenge/case.h"
#include "cl/device.h"
#include "core/stop.h"
#include "diagnose/infer/effects.h"

namespace mcdem::inline challenge {

class CaseSimulator {
public:
    /// Throws InputError if the scene is unsuitable for a challenge.
    CaseSimulator(Device& device, const Scene& scene, const Measurement& measurement);

    /// The scene with the stated properties of its instrument, without hidden effects.
    const Model& stated() const { return stated_; }
    const std::vector<Nuisance>& nuisances() const { return nuisances_; }

    /// Makes the initial packings of the cases, by number. Throws Interrupted.
    void make_packings(const std::vector<std::uint64_t>& seeds, const StopWanted& stop_wanted);

    /// One unmeasured recording per case; shorter if a case fails. `Part`: scans of the first loading, or
    /// all.
    enum class Part { loading, all };
    std::vector<Recording> simulate(std::span<const ChallengeCase* const> cases, Part part,
                                    const std::function<void(double fraction)>& on_progress) const;

    /// The recording measured by the instrument of the case, in the stated box, with the name of its folder.
    Experiment experiment(const ChallengeCase& c, Recording recording) const;

    /// Number of cases to simulate together.
    std::size_t at_once() const;

private:
    Model model_of_case(const ChallengeCase& c) const;

    Device& device_;
    Scene scene_;
    Model stated_;
    std::vector<Nuisance> nuisances_;
    std::vector<Packing> packings_;
};

}  // namespace mcdem::challenge
