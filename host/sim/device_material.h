// The materials of a replica's grains in the form the kernels read.
#pragma once
#include <vector>

#include "scene/scene.h"
#include "sim/device_types.h"

namespace mcdem::inline sim {

/// Of waves along the surface of a material, sqrt(G / rho) (0.163 nu + 0.8766) [m/s].
double rayleigh_speed(const GrainMaterial& material);

/// 2 sqrt(5/6) beta with beta = -ln e / sqrt(ln^2 e + pi^2): constant restitution with a Hertz contact.
double damping_factor(double restitution);

/// Materials of each replica in the field of materials: MAX_SPECIES where some replica has several species,
/// else one, which is not read.
int materials_kept(const std::vector<Replica>& replicas);

/// Material: f32::Material or f64::Material. `kept` of each replica, replica after replica; those beyond its
/// species are zero.
template <class Material>
std::vector<Material> device_materials(const std::vector<Replica>& replicas, int kept);

}  // namespace mcdem::sim
