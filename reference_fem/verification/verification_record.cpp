#include "reference_fem/verification/verification_record.hpp"

#include <fmt/format.h>

#include <cmath>

namespace reference_fem {
namespace {

using analysis::Columns;
using analysis::within;

const Columns<RowQuantity> quantity_columns = {
    {"quantity", &RowQuantity::key, "", "what is computed, as an identifier"},
    {"setting", &RowQuantity::setting, "", "an identifier that distinguishes rows with the same quantity"},
    {"description", &RowQuantity::description, "", "the same in words, with the settings that it belongs to"}};
const Columns<RowElements> element_columns = {
    {"element_order", &RowElements::order, "", "1 linear, 2 quadratic; empty in a row without finite elements"},
    {"formulation", &RowElements::formulation, "",
     "displacement, mean_dilatation or taylor_hood; without finite elements pbs, volume_constraints or one_point"}};
const Columns<RowMaterial> material_columns = {
    {"material", &RowMaterial::law, "", "constitutive law, as an identifier"},
    {"poisson", &RowMaterial::poisson, "", "Poisson's ratio, of an elastic law"}};
const Columns<VerificationRow> bound_columns = {
    {"low", &VerificationRow::low, "", "lower bound of the value"},
    {"high", &VerificationRow::high, "", "upper bound of the value"},
    {"bound_from", &VerificationRow::bound_from, "", "where the bounds are from"},
    {"observed_order", &VerificationRow::observed_order, "", "observed order of convergence"},
    {"expected_order", &VerificationRow::expected_order, "", "order of convergence by theory"},
    {"note", &VerificationRow::note, "", "remark"}};

std::string verdict_of(const VerificationRow& row)
{
    const std::optional<bool> held = holds(row);
    return !held ? "" : *held ? "yes" : "no";
}

}  // namespace

std::string RowElements::text() const
{
    if (!order) return formulation;
    return fmt::format("P{}{}", *order, formulation == "displacement" ? "" : " " + formulation);
}

std::optional<double> difference_pct(const VerificationRow& row)
{
    if (row.reference == 0.0) return std::nullopt;
    return 100.0 * (row.value - row.reference) / std::abs(row.reference);
}

std::optional<bool> holds(const VerificationRow& row)
{
    if (!row.low && !row.high && !row.expected_order) return std::nullopt;
    bool holds = std::isfinite(row.value);
    if (row.low) holds &= row.value >= *row.low;
    if (row.high) holds &= row.value <= *row.high;
    if (row.expected_order)
        holds &= row.observed_order && std::abs(*row.observed_order - *row.expected_order) <= order_tolerance;
    return holds;
}

const Columns<VerificationRow>& verification_columns()
{
    static const Columns<VerificationRow> columns =
        Columns<VerificationRow>{{"problem", &VerificationRow::problem, "", "name of the problem"}} +
        within(&VerificationRow::quantity, quantity_columns) + within(&VerificationRow::elements, element_columns) +
        within(&VerificationRow::material, material_columns) +
        Columns<VerificationRow>{
            {"mesh", &VerificationRow::mesh, "", "the mesh in words"},
            {"h_m", &VerificationRow::h_m, "m", "size of its elements"},
            {"dofs", &VerificationRow::dofs, "", "degrees of freedom"},
            {"value", &VerificationRow::value, "", "computed value, in the row's unit"},
            {"reference", &VerificationRow::reference, "", "value that it is compared with, in the row's unit"},
            {"unit", &VerificationRow::unit, "", "unit of both"},
            {"source", &VerificationRow::source, "", "where the reference is from"},
            {"difference_pct", difference_pct, "%", "difference of the value from the reference"}} +
        bound_columns +
        Columns<VerificationRow>{{"holds", verdict_of, "", "yes, no, or empty where the row has no bounds"}};
    return columns;
}

}  // namespace reference_fem
