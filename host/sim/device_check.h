// Compares a device with the same computation in double precision on the host, so that a driver that
// compiles the kernels wrongly is noticed.
#pragma once
#include <string>

#include "cl/device.h"
#include "core/names.h"
#include "sim/reference/comparison.h"

namespace mcdem::inline sim {

/// Relative difference of a device from the reference (sim/reference/step_reference.h).
class DeviceCheck {
public:
    explicit DeviceCheck(Precision precision) : precision_(precision) {}

    /// One more step of a replica.
    void add(ContactModel model, const IntervalResult& result, const reference::Differences& differences);

    Precision precision() const { return precision_; }
    bool passed() const { return passed_; }
    double difference() const { return difference_; }  ///< the one that comes closest to what is allowed
    double allowed() const { return allowed_; }
    /// "by 2.0e-06 (allowed 5e-05) in float precision with the model mc_dem"
    std::string text() const;

private:
    Precision precision_;
    ContactModel model_{};
    double difference_ = 0, allowed_ = 1;
    bool passed_ = true;
};

/// A hundred grains with each contact model, between walls, with friction, along six steps.
DeviceCheck check_device(Device& device, Precision precision);

}  // namespace mcdem::sim
