// Ranges and scopes for the rows of the key tables.
#pragma once
#include "scene/read/keys.h"

namespace mcdem::inline scene::rows {

constexpr Range above_zero_to(double high) { return {0, high, Range::Low::excluded}; }
constexpr Range between(double low, double high) { return {low, high, Range::Low::included}; }
constexpr Range none{};

// Limits are wide: they exclude impossible values and overflow, not unusual values.
constexpr Range length = above_zero_to(1000), stiffness = above_zero_to(1e13),
                mass_density = above_zero_to(1e5);
constexpr Range poisson = between(0, 0.5), friction = between(0, 10), bounce = above_zero_to(1);
constexpr Range grain_size = between(1e-7, 10), duration = above_zero_to(1e6);

constexpr Scope one_run = Scope::run, each = Scope::replica;

}  // namespace mcdem::scene::rows
