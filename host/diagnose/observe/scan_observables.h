// Observables of one scan that exist for measured and simulated packings. Global ones describe the packing.
// Conditional ones take the measured positions as given and compare each contact's force with the model; they
// average over thousands of contacts and are not affected by chaotic rearrangements.
#pragma once
#include <Eigen/Core>
#include <span>
#include <string_view>

#include "diagnose/observe/contact_residuals.h"

namespace mcdem::inline diagnose {

enum class Needs { plate, contacts, positions, programme };  ///< positions: contacts as well

struct Observable {
    std::string_view name;
    Needs needs;
    double resolution;        ///< smaller differences are ignored: numerics, damping, drift of the instrument
    std::string_view region;  ///< part of the packing; empty: all
    std::string_view force_class;  ///< class of forces; empty: all
    std::string_view meaning;
};

/// The order of the vectors that scan_observables returns.
std::span<const Observable> observables();

/// Observables that need several scans or the stroke: the last ones in the list (observation.cpp).
enum class OfProgramme { displacement, relaxation, creep };
Eigen::Index index_of(OfProgramme observable);

/// NaN for observables that the scan does not determine.
Eigen::VectorXd scan_observables(const Recording& recording, const Scan& scan,
                                 const ReferenceMaterial& material);

}  // namespace mcdem::diagnose
