// All bits of a recording's scans.
#pragma once
#include <string>

#include "core/recording.h"

namespace mcdem {

inline std::string bits_of(const Recording& recording) {
    std::string bits;
    const auto add = [&](const auto& value) {
        bits.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    for (const Scan& scan : recording.scans) {
        add(scan.time);
        add(scan.kinetic_energy);
        add(scan.elastic_energy);
        for (const double term : {scan.wall_work, scan.weight_work, scan.damping_loss, scan.friction_loss,
                                  scan.drag_loss, scan.energy_error})
            add(term);
        add(scan.packing_fraction);
        for (const Vec3& force : scan.wall_force)
            for (int axis = 0; axis < 3; ++axis) add(force[axis]);
        for (const Vec3& position : scan.position)
            for (int axis = 0; axis < 3; ++axis) add(position[axis]);
        for (const Contact& contact : scan.contacts) {
            add(contact.grain);
            add(contact.partner);
            for (int axis = 0; axis < 3; ++axis) add(contact.force[axis]);
            for (int axis = 0; axis < 3; ++axis) add(contact.point[axis]);
            add(contact.overlap);
        }
    }
    return bits;
}

}  // namespace mcdem
