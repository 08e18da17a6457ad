#include "io/grain_loads.h"

namespace mcdem::inline io {

std::vector<GrainLoad> grain_loads(const Scan& scan) {
    std::vector<GrainLoad> loads(scan.position.size());
    for (const Contact& contact : scan.contacts) {
        for (const int grain : {contact.grain, contact.partner}) {
            if (is_wall(grain)) continue;
            GrainLoad& load = loads[static_cast<std::size_t>(grain)];
            load.contacts += 1;
            load.force_magnitude += contact.force.norm();
        }
        if (is_wall(contact.partner))
            loads[static_cast<std::size_t>(contact.grain)].wall_force += contact.force;
    }
    return loads;
}

}  // namespace mcdem::io
