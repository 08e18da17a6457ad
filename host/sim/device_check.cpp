#include "sim/device_check.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace mcdem::inline sim {

void DeviceCheck::add(ContactModel model, const IntervalResult& result,
                      const reference::Differences& differences) {
    const double allowed = reference::tolerance(precision_, model);
    const bool alike = result.status == 0 && differences.same_contacts;
    const double difference = alike ? differences.worst() : std::numeric_limits<double>::infinity();
    passed_ &= difference <= allowed;  // not with not-a-number
    if (!std::isnan(difference_) && !(difference / allowed <= difference_ / allowed_)) {
        model_ = model;
        difference_ = difference;
        allowed_ = allowed;
    }
}

std::string DeviceCheck::text() const {
    return fmt::format("by {:.1e} (allowed {:.0e}) in {} precision with the model {}", difference_, allowed_,
                       name(precision_), name(model_));
}

DeviceCheck check_device(Device& device, Precision precision) {
    std::vector<reference::Start> starts;
    for (const ContactModel model : reference::all_models) {
        Replica replica = reference::test_replica(model);
        replica.contact.friction_law = FrictionLaw::mindlin;
        starts.push_back(reference::jittered_lattice(replica, 100, 1));
    }
    DeviceCheck check(precision);
    reference::compare_steps(device, kernel_build(device, precision, 16), starts, 2, 1, 5,
                             [&](int, std::size_t replica, const IntervalResult& result,
                                 const reference::Differences& differences) {
                                 check.add(reference::all_models[replica], result, differences);
                             });
    return check;
}

}  // namespace mcdem::sim
