// Finite strain of a grain: work, pressure and deviator against the formulas in double precision, and the
// surface displacements against the derivative of that work with respect to the forces.
#include "kernels/test_kernel.h"
#include "sim/device_replica.h"
#include "sim/reference/grain_reference.h"

namespace mcdem::reference::finite_strain {
namespace {

constexpr int slots = 16, read = 7, written = 4;
constexpr double radius = 0.01, youngs_modulus = 2e4;

/// A grain with forces at some of its slots; the others are neighbours that do not touch.
struct Loaded {
    Grain grain;
    double excess_compliance = 0;  ///< E/E_i - 1
};

/// What the kernels find for a grain.
struct Found {
    std::vector<double> displacement;  ///< of every slot [m]
    double work = 0;                   ///< [J]
    double pressure = 0, deviator = 0;
};

/// Contacts with small neighbours, so that large pressures have contact radii within the range of the law.
void press(Grain& grain, Slot& slot, double force) {
    const double modulus = grain.youngs_modulus / (2 * (1 - std::pow(grain.poisson_ratio, 2)));
    slot.force = force;
    slot.contact_radius = std::cbrt(0.75 * std::abs(force) * 0.1 * grain.radius / modulus);
}

Loaded grain_of(double poisson_ratio, const std::vector<Vec3>& directions, double excess_compliance = 0) {
    Loaded loaded{{radius, youngs_modulus / (1 + excess_compliance), poisson_ratio, {}}, excess_compliance};
    for (const Vec3& direction : directions)
        loaded.grain.slots.push_back({direction.normalized(), radius, 0, 0});
    return loaded;
}

/// Unit of forces of a grain, 4 pi E R^2 [N].
double area(const Grain& grain) {
    return 4 * std::numbers::pi * grain.youngs_modulus * grain.radius * grain.radius;
}

std::vector<Found> confined(double poisson_ratio, const std::vector<Loaded>& grains, const KernelBuild& way) {
    Replica scene = test_replica(ContactModel::hyperelastic_sphere);
    scene.grains.youngs_modulus = youngs_modulus;
    scene.grains.poisson_ratio = poisson_ratio;
    const auto replica = mcdem::device_replica<mcdem::f32::Replica>(
        scene, {{Vec3::Constant(radius)}, {2 * radius}}, {0, 1, 0});
    std::vector<float> in;
    for (std::size_t i = 0; i < (grains.size() + 15) / 16 * 16; ++i) {
        const Loaded& loaded = grains[std::min(i, grains.size() - 1)];
        for (std::size_t k = 0; k < slots; ++k) {
            const Slot slot = k < loaded.grain.slots.size() ? loaded.grain.slots[k] : Slot{Vec3(0, 0, 1)};
            for (const double number : {slot.direction.x(), slot.direction.y(), slot.direction.z(), slot.arm,
                                        slot.force, slot.contact_radius, loaded.excess_compliance})
                in.push_back(static_cast<float>(number));
        }
    }
    const auto out = mapped_slots(R"(
        const Moving now = {ZERO3, R(0.01), ZERO3, READ(0, 6), ZERO3, R(0)};
        const Grain at = grain_at(replica, 0, 0, first, 0, now);
        for (int v = 0; v < at.count; ++v) {
            const lanes3 direction = {READ(v, 0), READ(v, 1), READ(v, 2)};
            Contacts c;
            c.arm = READ(v, 3);
            c.elastic = READ(v, 4);
            c.radius = READ(v, 5);
            tabulate(c, direction, v, table);
        }
        SYNCHRONISE();
        SurfaceDisplacement b[SLOTS_HERE];
        surface_displacement(at, table, b);
        const Confined grain = confined(at, b, table);
        const Confinement shared = confinement_of(at, grain);
        for (int v = 0; v < at.count; ++v) {
            WRITE(v, 0, confined_displacement(at, shared, b[v], v, table));
            WRITE(v, 1, confined_work(at, grain));
            WRITE(v, 2, grain.pressure);
            WRITE(v, 3, grain.deviator);
        })",
                                  replica, in, read, written, way);
    std::vector<Found> found(grains.size());
    for (std::size_t i = 0; i < grains.size(); ++i) {
        const float* row = &out[i * slots * written];
        for (std::size_t k = 0; k < grains[i].grain.slots.size(); ++k)
            found[i].displacement.push_back(row[k * written]);
        found[i].work = row[1], found[i].pressure = row[2], found[i].deviator = row[3];
    }
    return found;
}

/// Work of the surface displacements [J], from the formula in kernels/confinement.h.
double work(const SurfaceLaw& law, const Grain& grain) {
    const Works w = works(law, grain);
    return confined_work(law.confinement, w, w.pressure) * grain.youngs_modulus * cubed(grain.radius);
}

/// Derivative of the work with respect to the force at slot k, at a contact radius by Hertz [m], less the
/// part that is solved within the step.
double displacement(const SurfaceLaw& law, const Grain& grain, std::size_t k) {
    const double force = grain.slots[k].force, step = (force == 0 ? 1e-9 : 1e-5) * area(grain);
    const auto with = [&](double change) {
        Grain changed = grain;
        press(changed, changed.slots[k], force + change);
        return work(law, changed);
    };
    const double at_once = force == 0 ? 0 : force * self_displacement(law, grain, grain.slots[k]);
    return (with(step) - with(-step)) / (2 * step) - at_once / (grain.youngs_modulus * grain.radius);
}

/// Grains with 2 to 12 contacts and some neighbours that do not touch, at mean pressures up to 0.6 E.
std::vector<Loaded> loaded_grains(double poisson_ratio) {
    Uniform uniform(7);
    std::vector<Loaded> all;
    for (int i = 0; i < 32; ++i) {
        std::vector<Vec3> directions;
        while (directions.size() < 14) {
            const Vec3 next = uniform.vector(1).normalized();
            const auto near = [&](const Vec3& other) { return next.dot(other) > std::cos(0.6); };
            if (std::none_of(directions.begin(), directions.end(), near)) directions.push_back(next);
        }
        Loaded loaded = grain_of(poisson_ratio, directions, i % 2 ? uniform(-0.3, 0.5) : 0);
        const int contacts = 2 + i % 11;
        const double pressure = 0.6 * std::pow((i + 1) / 32.0, 2);
        for (int k = 0; k < contacts; ++k)
            press(loaded.grain, loaded.grain.slots[k],
                  std::min(pressure / contacts, 0.08) * uniform(0.5, 1.5) * area(loaded.grain));
        all.push_back(loaded);
    }
    return all;
}

TEST(Confinement, DisplacementsAreTheDerivativeOfTheWork) {
    for (const double nu : {0.2, 0.35, 0.49}) {
        const SurfaceLaw law = mcdem::surface_law(ContactModel::hyperelastic_sphere, nu, 0);
        const auto grains = loaded_grains(nu);
        for (const KernelBuild& way : all_ways(build(Precision::single_precision))) {
            const auto found = confined(nu, grains, way);
            for (std::size_t i = 0; i < grains.size(); ++i) {
                const Grain& grain = grains[i].grain;
                const double expected = work(law, grain);
                EXPECT_NEAR(found[i].work, expected, 5e-5 * std::abs(expected))
                    << "nu " << nu << " grain " << i;
                for (std::size_t k = 0; k < grain.slots.size(); ++k)
                    EXPECT_NEAR(found[i].displacement[k], displacement(law, grain, k), 1e-5 * radius)
                        << "nu " << nu << " grain " << i << " slot " << k;
            }
        }
    }
}

// P = sum F/(4 pi E R^2); D = tr T^2 - P^2/3 = P^2 (1/n - 1/3) for equal forces along both directions of n
// axes.
TEST(Confinement, PressureAndDeviatorOfForcesAlongAxes) {
    constexpr double nu = 0.45, share = 0.02;
    const Vec3 x(1, 2, -2), y(2, 1, 2), z(-2, 2, 1);  // orthogonal
    std::vector<Loaded> grains{grain_of(nu, {x, -x}), grain_of(nu, {x, -x, y, -y}, 0.4),
                               grain_of(nu, {x, -x, y, -y, z, -z})};
    for (Loaded& loaded : grains)
        for (Slot& slot : loaded.grain.slots) press(loaded.grain, slot, share * area(loaded.grain));
    for (const KernelBuild& way : all_ways(build(Precision::single_precision))) {
        const auto found = confined(nu, grains, way);
        for (std::size_t axes = 1; axes <= 3; ++axes) {
            const double pressure = 2.0 * static_cast<double>(axes) * share;
            const double deviator = pressure * pressure * (1.0 / static_cast<double>(axes) - 1.0 / 3);
            EXPECT_NEAR(found[axes - 1].pressure, pressure, 1e-6 * pressure);
            EXPECT_NEAR(found[axes - 1].deviator, deviator, 1e-6 * pressure * pressure);
        }
    }
}

}  // namespace
}  // namespace mcdem::reference::finite_strain
