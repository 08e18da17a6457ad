// Few or ordered grains that are compressed equally at every contact: one grain between two, four or six
// plates, a row of three, and simple cubic, face-centred and hexagonal cells. Contacts of random packings
// differ, which hides modes in which equal contacts act together.
#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "reference/test_scene.h"

namespace mcdem::reference::ordered {

inline constexpr double radius = 0.01, youngs_modulus = 23.3e3, density = 11.5;

enum class Order { two_plates, four_plates, six_plates, row_of_three, simple_cubic, face_centred, hexagonal };

inline constexpr Order all_orders[]{Order::two_plates,   Order::four_plates,  Order::six_plates,
                                    Order::row_of_three, Order::simple_cubic, Order::face_centred,
                                    Order::hexagonal};

inline const char* name(Order order) {
    constexpr const char* names[]{"two plates",   "four plates",  "six plates", "row of three",
                                  "simple cubic", "face-centred", "hexagonal"};
    return names[static_cast<int>(order)];
}

inline bool is_crystal(Order order) { return order >= Order::simple_cubic; }

/// Without weight. Cubic crystals would buckle without friction, which exerts no force as long as they are
/// straight.
inline Replica ordered_replica(ContactModel model, double poisson_ratio, double restitution) {
    Replica replica;
    replica.grains = {youngs_modulus, poisson_ratio, density, 0, 0.5, restitution, 0};
    replica.walls = {1e12, 0.5, 0, restitution};
    replica.contact.model = model;
    replica.contact.gamma = 1.125;
    replica.numerics.overlap_limit = 1;  // where solutions exist beyond the default
    return replica;
}

/// A repeated unit: edges and positions over the distance of touching grains, and how often it is repeated.
struct Unit {
    Vec3 edge;
    std::vector<Vec3> position;
    std::array<int, 3> times;
};

/// The repeated cells are at least 2.4 distances wide, so no grain is a neighbour of two images of another.
inline Unit unit_of(Order order) {
    const double half = std::sqrt(0.5), third = std::sqrt(1.0 / 3);
    if (order == Order::simple_cubic) return {Vec3(1, 1, 1), {Vec3::Zero()}, {3, 3, 3}};
    if (order == Order::face_centred)
        return {2 * half * Vec3(1, 1, 1),
                {Vec3::Zero(), {0, half, half}, {half, 0, half}, {half, half, 0}},
                {2, 2, 2}};
    const double layer = std::sqrt(2.0 / 3);
    return {{1, 3 * third, 2 * layer},
            {Vec3::Zero(), {0.5, 1.5 * third, 0}, {0.5, 0.5 * third, layer}, {0, 2 * third, layer}},
            {3, 2, 2}};
}

inline Start crystal(Replica replica, Order order, double overlap) {
    const double distance = 2 * radius * (1 - overlap);
    const Unit unit = unit_of(order);
    Start start{std::move(replica), {}};
    for (int x = 0; x < unit.times[0]; ++x)
        for (int y = 0; y < unit.times[1]; ++y)
            for (int z = 0; z < unit.times[2]; ++z)
                for (const Vec3& at : unit.position) {
                    start.packing.position.push_back(distance * (at + Vec3(x, y, z).cwiseProduct(unit.edge)));
                    start.packing.diameter.push_back(2 * radius);
                }
    const Vec3 size = distance * Vec3(unit.times[0], unit.times[1], unit.times[2]).cwiseProduct(unit.edge);
    start.replica.box = {size.x(), size.y(), mcdem::ContainerShape::cell, size.z()};
    start.replica.plate.start = size.z();
    return start;
}

/// `overlap`: geometric, of every contact, over the sum of radii; of a contact with a plate over the radius.
/// The walls do not move. A row of three is also held by four side walls at half the overlap, without which
/// it would buckle.
inline Start ordered_start(Replica replica, Order order, double overlap) {
    if (is_crystal(order)) return crystal(std::move(replica), order, overlap);
    const double near = radius * (1 - overlap), beside = radius * (1 - overlap / 10);
    constexpr double far = 3 * radius;  // half the width of a box whose walls touch no grain
    const bool row = order == Order::row_of_three, six = order == Order::six_plates;
    const int grains = row ? 3 : 1;
    const Vec3 half(row                                  ? beside
                    : six || order == Order::four_plates ? near
                                                         : far,
                    row   ? beside
                    : six ? near
                          : far,
                    near);
    Start start{std::move(replica), {}};
    for (int i = 0; i < grains; ++i) {
        start.packing.position.push_back(half + Vec3(0, 0, 2 * near * i));
        start.packing.diameter.push_back(2 * radius);
    }
    start.replica.box = {2 * half.x(), 2 * half.y()};
    start.replica.plate.start = 2 * near * grains;
    start.replica.plate.end = 0.9 * start.replica.plate.start;
    return start;
}

}  // namespace mcdem::reference::ordered
