// Independent, slower computation of the values of host/elasticity/elastic_sphere_series.h: each mode from
// its 2 x 2 system of tractions, averages over caps by Simpson's rule. Radius and Young's modulus are 1.
#pragma once
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace mcdem::reference {

class SphereSeries {
public:
    explicit SphereSeries(double poisson_ratio) : nu_(poisson_ratio) {
        for (int n = 0; n <= far_terms; ++n) {
            modes_.push_back(mode(n));
            filter_.push_back(std::exp(-36 * std::pow(double(n) / far_terms, 8)));
        }
    }

    /// Displacements (U, V) of order n = matrix * tractions (t_r, t_t).
    Eigen::Matrix2d mode(int n) const {
        const double k = 1 - 2 * nu_, shear = 1 / (2 * (1 + nu_));
        if (n == 0) return (Eigen::Matrix2d() << k, 0, 0, 0).finished();
        if (n == 1) return uniform_force_mode(k);
        Eigen::Matrix2d traction, displacement;
        // The second solution is scaled by `den`, so that it remains finite at nu = 1/2.
        const double den = (n + 3) * 2 * nu_ + (n + 5) * k, alpha_den = -2 * (n * 2 * nu_ + (3 * n + 1) * k);
        const double lambda_divergence = 2 * nu_ * (2 * n * (n + 5) - 2 * (n + 3) * (3 * n + 1));
        displacement << n, n * den + alpha_den, 1, den;
        traction << 2 * n * (n - 1), lambda_divergence + 2 * (n + 1) * (n * den + alpha_den),  //
            2 * (n - 1), 2 * n * den + alpha_den;
        return displacement * (shear * traction).inverse();
    }

    /// Displacement at s = sin(theta/2) by a point load; contribution per unit of 2/5 a_k^2 + 2/3 a_c^2.
    double point(double s) const {
        return sum(s, [&](int n) { return modes_[n](0, 0); });
    }
    double size(double s) const {
        return sum(s,
                   [&](int n) { return modes_[n](0, 1) / 2 - (0.5 + n * (n + 1) / 4.0) * modes_[n](0, 0); });
    }

    /// Displacement of a contact of radius a by its own force beyond Hertz: sphere minus half space, and
    /// exact gap minus parabola.
    double self(double a) const {
        const double half_space = -(1 - nu_ * nu_) / (2 * a);
        double gap = 0;
        for (const Node& node : nodes(a))
            gap += node.punch * (1 - node.cosine - (1 - node.cosine * node.cosine) / 2);
        return spread_load(a, a, 0) - half_space - gap * (1 - nu_ * nu_) / (4.0 / 3 * a * a * a);
    }

    /// Displacement along the plate normal, averaged over a punch of radius a_c, by a unit Hertz pressure of
    /// radius a_k, without expansion in the radii. s as above; 0 for the same cap.
    double spread_load(double a_k, double a_c, double s) const {
        auto sources = nodes(a_k), receivers = nodes(a_c);
        const int terms = std::max(400, int(120 / std::min(a_k, a_c)));
        double total = 0, legendre = 1, before = 0;
        for (int n = 0; n <= terms; ++n) {
            // (radial, meridional) parts of the unit vector -e; meridional per n (n + 1)
            const Eigen::Vector2d source = moment(sources, n, &Node::hertz);
            const Eigen::Vector2d receiver = moment(receivers, n, &Node::punch);
            const Eigen::Vector2d moved = mode(n) * source;
            total -= (2 * n + 1) / (4 * std::numbers::pi) * legendre *
                     (receiver.x() * moved.x() + n * (n + 1.0) * receiver.y() * moved.y());
            advance(n, 1 - 2 * s * s, legendre, before);
        }
        return total;
    }

private:
    static constexpr int far_terms = 1200;
    struct Node {
        double cosine, punch, hertz;  // weights of the two pressures; each set sums to 1
        double legendre = 1, before = 0;
    };

    /// Recursion from P_n and P_{n-1} to P_{n+1} and P_n.
    static void advance(int n, double x, double& legendre, double& before) {
        before = ((2 * n + 1) * x * legendre - n * before) / (n + 1);
        std::swap(legendre, before);
    }

    /// Moment of order n of a pressure; advances the nodes to n + 1.
    static Eigen::Vector2d moment(std::vector<Node>& caps, int n, double Node::*weight) {
        Eigen::Vector2d sum(0, 0);
        for (Node& node : caps) {
            const double slope = n > 0 ? (node.cosine * node.legendre - node.before) / (n + 1) : 0;
            sum += node.*weight * Eigen::Vector2d(-node.cosine * node.legendre, slope);
            advance(n, node.cosine, node.legendre, node.before);
        }
        return sum;
    }

    /// A uniform body force balances the load. The fields r^2 grad z and x z also cover the incompressible
    /// limit.
    Eigen::Matrix2d uniform_force_mode(double k) const {
        // Tractions times k over the shear modulus (lambda/mu = 2 nu/k):
        //   4 nu + 4 k   8 nu + 4 k
        //   2 k          k            with determinant -k (12 nu + 4 k)
        const double shear = 1 / (2 * (1 + nu_));
        Eigen::Matrix2d adjugate, displacement;
        adjugate << k, -(8 * nu_ + 4 * k), -2 * k, 4 * nu_ + 4 * k;
        displacement << 1, 1, 1, 0;
        Eigen::Matrix2d c = displacement * adjugate / (-(12 * nu_ + 4 * k) * shear);
        const double even = (c(0, 1) + 2 * c(1, 0)) / 2;  // the rest is a rigid translation
        c(0, 1) = even;
        c(1, 0) = even / 2;
        return c;
    }

    template <class Coefficient>
    double sum(double s, Coefficient coefficient) const {
        const double x = 1 - 2 * s * s;
        double total = 0, legendre = 1, before = 0;
        for (int n = 0; n <= far_terms; ++n) {
            total -= (2 * n + 1) / (4 * std::numbers::pi) * filter_[n] * coefficient(n) * legendre;
            advance(n, x, legendre, before);
        }
        return total;
    }

    static std::vector<Node> nodes(double a) {
        constexpr int intervals = 1000;
        const double h = std::numbers::pi / 2 / intervals;
        std::vector<Node> all;
        for (int i = 0; i <= intervals; ++i) {
            const double psi = i * h, simpson = h / 3 * (i == 0 || i == intervals ? 1 : i % 2 ? 4 : 2);
            const double r = a * std::sin(psi), punch = simpson * std::sin(psi);
            all.push_back({std::sqrt(1 - r * r), punch, 3 * punch * std::cos(psi) * std::cos(psi)});
        }
        return all;
    }

    double nu_;
    std::vector<Eigen::Matrix2d> modes_;
    std::vector<double> filter_;
};

}  // namespace mcdem::reference
