// The longest stable time step: of an oscillator with a delayed force, against the eigenvalues of one step;
// of grains between plates, with gains from the double-precision reference.
#include <Eigen/Eigenvalues>

#include "kernels/test_kernel.h"
#include "sim/reference/grain_reference.h"

namespace mcdem::reference::stable_step {
namespace {

/// Largest absolute eigenvalue of one step of a unit mass with a spring of unit stiffness, whose force is
/// f = -x + gain f', with f' extrapolated from the forces 1, 3 and 5 steps before, and a damping constant.
double amplification(double gain, double damping, double dt) {
    constexpr int states = 7;  // x, v, and the last five forces
    Eigen::Matrix<double, states, states> step = Eigen::Matrix<double, states, states>::Zero();
    Eigen::Matrix<double, 1, states> force;
    force << -1, 0, gain * 10 / 6, 0, -gain * 5 / 6, 0, gain / 6;
    step.row(1) = dt * force;
    step(1, 1) += 1 - damping * dt;
    step.row(0) = dt * step.row(1);
    step(0, 0) += 1;
    step.row(2) = force;
    for (int k = 3; k < states; ++k) step(k, k - 1) = 1;
    return step.eigenvalues().cwiseAbs().maxCoeff();
}

/// Up to which every shorter step is stable.
double longest_stable(double gain, double damping) {
    double dt = 0.03;
    while (amplification(gain, damping, dt * 1.002) <= 1 + 1e-12) dt *= 1.002;
    return dt;
}

// The table has phases in factors of 1.09, and the derivation neglects the damping's effect on the frequency.
TEST(StableStep, IsThatOfAnOscillatorWithADelayedForce) {
    std::vector<float> in;
    for (const double gain : {-0.6, -0.2, 0.05, 0.15, 0.3, 0.5, 0.7, 0.85})
        for (const double damping : {3e-4, 3e-3, 0.03, 0.1}) {
            in.push_back(static_cast<float>(gain));
            in.push_back(static_cast<float>(damping));
        }
    const auto found = mapped_rows(R"(
        const lanes longest = stable_phase(in[0], in[1]);
        out[0] = LANE(real, longest, 0);)",
                                   {}, in, 2, 1);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const double truth = longest_stable(in[2 * i], in[2 * i + 1]);
        EXPECT_LT(found[i], 1.01 * truth) << "gain " << in[2 * i] << ", damping " << in[2 * i + 1];
        if (in[2 * i] > 0 && truth < 0.9) {
            EXPECT_GT(found[i], 0.85 * truth) << "gain " << in[2 * i] << ", damping " << in[2 * i + 1];
        }
    }
}

TEST(StableStep, TheMainAxisIsThatOfTheLargestEigenvalue) {
    Uniform uniform(3);
    std::vector<float> in;
    std::vector<Eigen::Matrix3d> tensors;
    for (int i = 0; i < 50; ++i) {
        Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();
        for (int k = 0; k <= i % 5; ++k) {
            const Vec3 n = uniform.vector(1).normalized();
            tensor += uniform(0.1, 1) * n * n.transpose();
        }
        if (i == 49) tensor.setIdentity();
        tensors.push_back(tensor);
        for (const auto& [row, column] : {std::pair(0, 0), {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}})
            in.push_back(static_cast<float>(tensor(row, column)));
    }
    const auto found = mapped_rows(R"(
        const Tensor tensor = {in[0], in[1], in[2], in[3], in[4], in[5]};
        const lanes3 axis = main_axis(tensor);
        out[0] = LANE(real, axis.x, 0); out[1] = LANE(real, axis.y, 0); out[2] = LANE(real, axis.z, 0);)",
                                   {}, in, 6, 3);
    for (std::size_t i = 0; i < tensors.size(); ++i) {
        const Vec3 axis(found[3 * i], found[3 * i + 1], found[3 * i + 2]);
        const double largest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tensors[i]).eigenvalues()[2];
        EXPECT_NEAR(axis.norm(), 1, 1e-5);
        EXPECT_GT(axis.dot(tensors[i] * axis), 0.99 * largest) << i;  // four squarings
    }
}

/// Gain and stiffness of a translation of the held grain, from finite differences of the reference, over E R.
struct Mode {
    double gain, stiffness, damping;
};

Mode translation(const Start& start, const mcdem::ReplicaState& state) {
    const double E = start.replica.grains.youngs_modulus, nu = start.replica.grains.poisson_ratio;
    const double R = start.packing.diameter[0] / 2, modulus = E / (1 - nu * nu);
    const auto law = mcdem::surface_law(start.replica.contact.model, nu, start.replica.contact.gamma,
                                        start.replica.effects.finite_strain);
    Grain grain{R, E, nu, {}};
    for (const auto& contact : state.contacts) {
        const Vec3 direction = (contact.point - state.position[0]).normalized();
        const double radius = std::sqrt(R * contact.overlap);
        const double force = 4.0 / 3 * modulus * radius * contact.overlap;
        grain.slots.push_back({direction, (contact.point - state.position[0]).norm(), force, radius});
    }
    const double overlap = state.contacts[0].overlap, force = grain.slots[0].force;
    const double own = law.self[0] != 0 ? self_displacement(law, grain, grain.slots[0]) / (E * R) : 0;
    const double stiffness = 1 / (overlap / (1.5 * force) - own);
    const auto moved = [&](double change) {
        Grain changed = grain;
        for (Slot& slot : changed.slots) slot.force += change * slot.direction.z();
        auto b = surface_displacement(law, changed);
        for (std::size_t c = 0; c < b.size(); ++c)
            if (law.self[0] != 0)
                b[c] -= self_displacement(law, changed, changed.slots[c]) * changed.slots[c].force / (E * R);
        return b;
    };
    const double step = 1e-4 * force;
    const auto plus = moved(step), minus = moved(-step);
    Mode mode{0, 0, 0};
    for (std::size_t c = 0; c < plus.size(); ++c) {
        const double q = grain.slots[c].direction.z();
        mode.gain += stiffness * q * (plus[c] - minus[c]) / (2 * step);
        mode.stiffness += stiffness * q * q;
        mode.damping += q * q;
    }
    mode.gain *= stiffness / mode.stiffness;
    const double mass = 4.0 / 3 * std::numbers::pi * std::pow(R, 3) * start.replica.grains.density;
    const double beta = -std::log(0.95) / std::hypot(std::log(0.95), std::numbers::pi);
    mode.damping *= 2 * std::sqrt(5.0 / 6) * beta * std::sqrt(1.5 * force / overlap * mass);
    return mode;
}

// Phases are in factors of 1.09. The kernels neglect that contact radii change with the force: 2 % of the
// step.
TEST(StableStep, OfAGrainBetweenPlatesFollowsFromItsGain) {
    for (const bool six : {false, true})
        for (const ContactModel model : all_models)
            for (const double overlap : {0.05, 0.15}) {
                if (model == ContactModel::independent) continue;
                const double near = 1 - overlap, side = six ? near : 3;
                const Start start = held_grain(model, 0.45, 0.95, {side, side, near});
                Batch batch(build(finest()), start);
                const auto result = batch.advance(200, 200);
                const bool half_space =
                    model == ContactModel::elastic_half_space || model == ContactModel::mc_dem;
                if (half_space && six && overlap > 0.1) continue;  // no static solution
                ASSERT_EQ(result[0].status, 0) << name(model);
                const Mode mode = translation(start, batch.engine().state(0));
                const double mass = 4e3 / 3 * std::numbers::pi * 1e-6;
                const double frequency = std::sqrt(mode.stiffness / mass);
                const double expected =
                    longest_stable(mode.gain, mode.damping / (mass * frequency)) / frequency;
                const std::string where =
                    fmt::format("{} {} {} gain {} damping {} truth {} found {}", name(model), overlap,
                                six ? "six" : "two", mode.gain, mode.damping / (mass * frequency),
                                expected * frequency, frequency / result[0].step_rate);
                EXPECT_LT(1 / result[0].step_rate, 1.02 * expected) << where;
                if (mode.gain > 0) {
                    EXPECT_GT(1 / result[0].step_rate, 0.78 * expected) << where;
                }
            }
}

}  // namespace
}  // namespace mcdem::reference::stable_step
