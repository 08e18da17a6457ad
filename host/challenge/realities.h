// Simulations of the cases of a challenge, with everything that is hidden in them.
#pragma once
#include <functional>
#include <span>

#include "challenge/case.h"
#include "cl/device.h"
#include "diagnose/infer/effects.h"

namespace mcdem::inline challenge {

class Realities {
public:
    /// Throws InputError where the scene does not suit a challenge.
    Realities(Device& device, const Scene& scene, const Measurement& measurement);

    /// The scene with what its instrument states, before anything is hidden in it.
    const Model& stated() const { return stated_; }
    const std::vector<Nuisance>& nuisances() const { return nuisances_; }

    /// The packings that cases start from, by number. Throws Interrupted.
    void make_packings(const std::vector<std::uint64_t>& seeds, const std::function<bool()>& stop_wanted);

    /// One recording a case, not yet measured; ended early where a case fails. `scans_needed`: of the first
    /// stroke, or all.
    enum class Part { loading, all };
    std::vector<Recording> simulate(std::span<const ChallengeCase* const> cases, Part part,
                                    const std::function<void(double fraction)>& on_progress) const;

    /// The recording as the case's instrument reads it, in the stated box, named by its folder.
    Experiment experiment(const ChallengeCase& c, Recording recording) const;

    /// How many cases to simulate together.
    std::size_t at_once() const;

private:
    Model reality_of(const ChallengeCase& c) const;

    Device& device_;
    Scene scene_;
    Model stated_;
    std::vector<Nuisance> nuisances_;
    std::vector<Packing> packings_;
};

}  // namespace mcdem::challenge
