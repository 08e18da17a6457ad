// Simulates the cases of a challenge with all their hidden effects (host/python/mcdem/challenge/make.py).
#pragma once
#include <string>
#include <vector>

#include "cl/device.h"
#include "core/stop.h"
#include "diagnose/effects.h"
#include "ensemble/diagnosis/simulations.h"

namespace mcdem::inline ensemble {

struct SimulatedCase {
    std::string folder;      ///< name of its experiment
    Amplitudes effects;      ///< of the library, or from outside_effects()
    Amplitudes nuisances;    ///< shifts
    int packing = 0;         ///< number of its packing
    std::uint64_t seed = 0;  ///< for its jitter, random properties of its effects, and its noise
};

class CaseSimulator {
public:
    /// `measurement`: accuracy of all measurements. Throws InputError if the scene is unsuitable for a
    /// challenge.
    CaseSimulator(const Scene& scene, const Measurement& measurement, const std::string& device);

    /// The scene with the stated properties of its instrument, without hidden effects.
    const Model& stated() const { return stated_; }
    const std::vector<Nuisance>& nuisances() const { return nuisances_; }

    /// Makes the initial packings of the cases, by number. Throws Interrupted.
    void make_packings(const std::vector<std::uint64_t>& seeds, const StopWanted& stop_wanted);

    /// Number of cases to simulate together.
    std::size_t at_once() const;

    /// `loading_only`: until all have the scans of the first loading. Returns where and why each case failed,
    /// empty if it did not. The recordings are kept for measured() until the next call.
    std::vector<std::string> simulate(std::vector<SimulatedCase> cases, bool loading_only,
                                      const Callbacks& callbacks);

    /// A case of the last call as the instrument of the case reads it, in the stated box, with the name of
    /// its folder.
    Recording measured(std::size_t k) const;

private:
    Model model_of_case(const SimulatedCase& c) const;
    Scene scene_;
    Model stated_;
    std::vector<Nuisance> nuisances_;
    Device device_;
    std::vector<Packing> packings_;
    std::vector<SimulatedCase> cases_;
    std::vector<Recording> recordings_;
};

}  // namespace mcdem::ensemble
