// Materials of grains in the format of the kernels.
#pragma once
#include <vector>

#include "scene/scene.h"
#include "sim/device_types.h"

namespace mcdem::inline sim {

/// 2 sqrt(5/6) beta with beta = -ln e / sqrt(ln^2 e + pi^2), which gives a constant restitution for Hertz
/// contacts.
double damping_factor(double restitution);

/// Number of materials per replica in the field of materials: MAX_SPECIES if a replica has several species,
/// otherwise one, which is not read.
int materials_kept(const std::vector<Replica>& replicas);

/// Material: f32::Material or f64::Material. `kept` materials for each replica, replica after replica; unused
/// ones are zero.
template <class Material>
std::vector<Material> device_materials(const std::vector<Replica>& replicas, int kept);

}  // namespace mcdem::sim
