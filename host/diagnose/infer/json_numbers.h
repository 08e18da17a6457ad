// JSON of optional values, of enumerations with names, and of vectors and matrices, with null for NaN.
#pragma once
#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/names.h"
#include "metrics/estimate.h"

namespace mcdem::inline diagnose {

/// Throws a nlohmann::json::exception if `right` is false.
inline void expect_json(bool right, const std::string& what, const nlohmann::json& where) {
    if (!right) throw nlohmann::json::other_error::create(501, what, &where);
}

}  // namespace mcdem::diagnose

namespace nlohmann {

template <class Value>
struct adl_serializer<std::optional<Value>> {
    static void to_json(json& j, const std::optional<Value>& value) { j = value ? json(*value) : json(); }
    static void from_json(const json& j, std::optional<Value>& value) {
        value = j.is_null() ? std::nullopt : std::optional(j.get<Value>());
    }
};

template <class Enum>
requires requires { mcdem::name_list<Enum>.size(); }
struct adl_serializer<Enum> {
    static void to_json(json& j, Enum value) { j = mcdem::name(value); }
    static void from_json(const json& j, Enum& value) {
        const auto found = mcdem::parse<Enum>(j.get<std::string>());
        mcdem::expect_json(found.has_value(), "there is no " + j.dump(), j);
        value = *found;
    }
};

/// NaN becomes null when the JSON is written.
template <>
struct adl_serializer<Eigen::VectorXd> {
    static void to_json(json& j, const Eigen::VectorXd& values) {
        j = std::vector<double>(values.begin(), values.end());
    }
    static void from_json(const json& j, Eigen::VectorXd& values) {
        values.resize(static_cast<Eigen::Index>(j.size()));
        for (std::size_t i = 0; i < j.size(); ++i)
            values[i] = j[i].is_null() ? mcdem::not_available : j[i].get<double>();
    }
};

/// By rows.
template <>
struct adl_serializer<Eigen::MatrixXd> {
    static void to_json(json& j, const Eigen::MatrixXd& rows) {
        j = json::array();
        for (const auto& row : rows.rowwise()) j.push_back(Eigen::VectorXd(row));
    }
    static void from_json(const json& j, Eigen::MatrixXd& rows) {
        const auto list = j.get<std::vector<Eigen::VectorXd>>();
        rows.resize(static_cast<Eigen::Index>(list.size()), list.empty() ? 0 : list.front().size());
        for (std::size_t r = 0; r < list.size(); ++r) {
            mcdem::expect_json(list[r].size() == rows.cols(), "its rows are of unequal length", j);
            rows.row(static_cast<Eigen::Index>(r)) = list[r];
        }
    }
};

}  // namespace nlohmann
