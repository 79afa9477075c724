#include "reference_fem/verification/verification_row.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace reference_fem {
namespace {

nlohmann::json to_json(const std::optional<double>& value)
{
    return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

std::optional<double> optional_number(const nlohmann::json& json, const char* key)
{
    return json.at(key).is_null() ? std::optional<double>() : json.at(key).get<double>();
}

// JSON knows no nan: null.
double number_or_nan(const nlohmann::json& json, const char* key)
{
    return optional_number(json, key).value_or(std::nan(""));
}

}  // namespace

std::string RowElements::text() const
{
    if (!order) return formulation;
    return fmt::format("P{}{}", *order, formulation == "displacement" ? "" : " " + formulation);
}

std::string RowMaterial::text() const
{
    return law + (poisson ? fmt::format(", poisson {:.6g}", *poisson) : "");
}

std::optional<double> difference_pct(const VerificationRow& row)
{
    if (row.reference == 0.0) return std::nullopt;
    return 100.0 * (row.value - row.reference) / std::abs(row.reference);
}

std::optional<bool> holds(const VerificationRow& row)
{
    if (!row.low && !row.high && !row.expected_order) return std::nullopt;
    bool all = std::isfinite(row.value);
    if (row.low) all &= row.value >= *row.low;
    if (row.high) all &= row.value <= *row.high;
    if (row.expected_order) all &= row.observed_order && std::abs(*row.observed_order - *row.expected_order) <= order_tolerance;
    return all;
}

nlohmann::json to_json(const VerificationRow& row)
{
    const std::optional<bool> held = holds(row);
    return {{"problem", row.problem},
            {"quantity", row.quantity.key},
            {"setting", row.quantity.setting},
            {"description", row.quantity.description},
            {"element_order", row.elements.order ? nlohmann::json(*row.elements.order) : nlohmann::json(nullptr)},
            {"formulation", row.elements.formulation},
            {"material", row.material.law},
            {"poisson", to_json(row.material.poisson)},
            {"mesh", row.mesh},
            {"h_m", row.h_m},
            {"dofs", row.dofs},
            {"value", row.value},
            {"reference", row.reference},
            {"unit", row.unit},
            {"source", row.source},
            {"difference_pct", to_json(difference_pct(row))},
            {"low", to_json(row.low)},
            {"high", to_json(row.high)},
            {"bound_from", row.bound_from},
            {"observed_order", to_json(row.observed_order)},
            {"expected_order", to_json(row.expected_order)},
            {"note", row.note},
            {"holds", held ? nlohmann::json(*held) : nlohmann::json(nullptr)}};
}

VerificationRow verification_row(const nlohmann::json& json)
{
    VerificationRow row;
    row.problem = json.at("problem");
    row.quantity = {json.at("quantity"), json.at("description"), json.at("setting")};
    if (!json.at("element_order").is_null()) row.elements.order = json.at("element_order").get<int>();
    row.elements.formulation = json.at("formulation");
    row.material = {json.at("material"), optional_number(json, "poisson")};
    row.mesh = json.at("mesh");
    row.h_m = json.at("h_m");
    row.dofs = json.at("dofs");
    row.value = number_or_nan(json, "value");
    row.reference = number_or_nan(json, "reference");
    row.unit = json.at("unit");
    row.source = json.at("source");
    row.low = optional_number(json, "low");
    row.high = optional_number(json, "high");
    row.bound_from = json.at("bound_from");
    row.observed_order = optional_number(json, "observed_order");
    row.expected_order = optional_number(json, "expected_order");
    row.note = json.at("note");
    return row;
}

}  // namespace reference_fem
