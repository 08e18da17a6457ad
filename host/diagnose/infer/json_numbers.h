// Vectors as JSON, with null for NaN.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <nlohmann/json.hpp>

#include "metrics/estimate.h"

namespace mcdem::inline diagnose {

inline nlohmann::json numbers_json(const Eigen::VectorXd& values) {
    nlohmann::json list = nlohmann::json::array();
    for (const double value : values)
        list.push_back(std::isfinite(value) ? nlohmann::json(value) : nlohmann::json());
    return list;
}

inline Eigen::VectorXd numbers_of(const nlohmann::json& list) {
    Eigen::VectorXd values(static_cast<Eigen::Index>(list.size()));
    for (std::size_t i = 0; i < list.size(); ++i)
        values[static_cast<Eigen::Index>(i)] = list[i].is_null() ? not_available : list[i].get<double>();
    return values;
}

}  // namespace mcdem::diagnose
