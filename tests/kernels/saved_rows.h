// State of the slots from an engine's saved state, by the user's grain numbers.
#pragma once
#include <algorithm>
#include <cstring>
#include <map>
#include <vector>

#include "core/recording.h"
#include "reference/test_scene.h"
#include "sim/device_types.h"
#include "sim/layout.h"

namespace mcdem::reference {

template <class T>
std::vector<T> saved_values(const std::map<std::string, std::vector<std::byte>>& saved,
                            const std::string& name) {
    const auto& bytes = saved.at(name);
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
}

/// Saved reals of either precision, as doubles.
inline std::vector<double> saved_reals(const std::map<std::string, std::vector<std::byte>>& saved,
                                       const std::string& name, Precision precision) {
    if (precision == Precision::double_precision) return saved_values<double>(saved, name);
    const auto reals = saved_values<float>(saved, name);
    return {reals.begin(), reals.end()};
}

class SavedRows {
public:
    SavedRows(Batch& batch, const KernelBuild& build, const std::vector<Start>& starts)
        : build_(build),
          saved_(batch.engine().save()),
          layout_(mcdem::make_layout(each(starts, &Start::packing), build.block())) {
        partner_ = saved_values<int>(saved_, "partner");
    }

    /// The row of one of the user's grains, with the kernels' numbers of grains and walls.
    std::vector<int> row(int replica, int grain) const {
        std::vector<int> entries;
        for (int c = 0; c < build_.slots; ++c)
            entries.push_back(partner_[build_.place_of_slot(index(replica, grain), c)]);
        return entries;
    }
    /// Index of a grain in the device's arrays.
    int index(int replica, int grain) const {
        return layout_.first_grain[replica] +
               static_cast<int>(std::ranges::find(layout_.order[replica], grain) -
                                layout_.order[replica].begin());
    }
    /// An entry of a row, in the user's numbers.
    int user_partner(int replica, int entry) const {
        if (entry < NO_PARTNER) return mcdem::wall_partner(static_cast<mcdem::Wall>(WALL_PARTNER(0) - entry));
        return layout_.order[replica][entry - layout_.first_grain[replica]];
    }
    /// Map from partner to a stored value, for one grain; of the contact memory one row.
    std::map<int, double> by_partner(const std::string& name, int replica, int grain,
                                     std::size_t stored_row = 0) const {
        const auto values = saved_reals(saved_, name, build_.precision);
        std::map<int, double> found;
        const auto entries = row(replica, grain);
        const std::size_t rows = values.size() / partner_.size();
        const std::size_t lane = index(replica, grain) % build_.lanes;
        const std::size_t block = build_.place_of_slot(index(replica, grain) - lane, 0);
        for (int c = 0; c < build_.slots; ++c)
            if (entries[c] != NO_PARTNER)
                found[user_partner(replica, entries[c])] =
                    values[rows * block + stored_row * build_.slots * build_.lanes +
                           build_.place_of_slot(lane, c)];
        return found;
    }
    std::vector<int> partner_slots() const { return saved_values<int>(saved_, "partner_slot"); }
    const std::vector<int>& partners() const { return partner_; }
    bool rebuilding(int replica) const { return saved_values<char>(saved_, "rebuild")[replica] != 0; }

private:
    KernelBuild build_;
    std::map<std::string, std::vector<std::byte>> saved_;
    mcdem::Layout layout_;
    std::vector<int> partner_;
};

}  // namespace mcdem::reference
