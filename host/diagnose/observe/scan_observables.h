// What is looked at in one scan: numbers that measured and simulated packings have alike. Global ones
// describe the packing; conditional ones take the measured positions as given and ask what each contact's
// force says about the model, so that they average over thousands of contacts and do not feel chaotic
// rearrangement.
#pragma once
#include <Eigen/Core>
#include <span>
#include <string_view>

#include "diagnose/observe/contact_residuals.h"

namespace mcdem::inline diagnose {

enum class Needs { plate, contacts, positions, programme };  ///< positions: contacts too

struct Observable {
    std::string_view name;
    Needs needs;
    double resolution;  ///< differences below it mean nothing: numerics, damping, the instrument's own drift
    std::string_view region;       ///< where it looks, empty: everywhere
    std::string_view force_class;  ///< which forces, empty: all
    std::string_view meaning;
};

/// The order of the vectors that scan_observables returns.
std::span<const Observable> observables();

/// Those that take more than one scan, or the stroke: the last ones of the list (observation.cpp).
enum class OfProgramme { displacement, relaxation, creep };
Eigen::Index index_of(OfProgramme observable);

/// Not-a-number where the scan does not tell.
Eigen::VectorXd scan_observables(const Recording& recording, const Scan& scan,
                                 const ReferenceMaterial& material);

}  // namespace mcdem::diagnose
