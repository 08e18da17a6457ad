// Why a replica stops, each with advice for the user.
#pragma once
#include <string>

#include "core/recording.h"
#include "sim/energy_budget.h"
#include "sim/engine.h"

namespace mcdem::inline sim {

/// For each reason in the status of an interval (kernels/status.h). `relaxes`: before the plate or the cell
/// has moved.
std::string cause_of(const IntervalResult& result, const Replica& replica, int slots, bool relaxes);

/// Because of numerics.stop_beyond_law; empty if the replica continues.
std::string beyond_law(const Replica& replica, const Scan& scan);

/// Why the time step is too long by the energy that it has created; empty if it is not.
std::string created_energy(const EnergyBudget& budget);

/// Why the forces on the walls and the weight [N] do not balance although the grains are at rest; empty if
/// they do.
std::string imbalance(const IntervalResult& result, double weight);

}  // namespace mcdem::sim
