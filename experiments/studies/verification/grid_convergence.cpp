// The grid convergence index of an error bar from two solutions, against a published example: pressure recovery on three grids (NPARC
// Alliance CFD Verification and Validation, tutorial "Examining spatial (grid) convergence", after P. J. Roache 1994). The example observes
// its order on the third grid, and its safety factor is 1.25; with two grids the order is presumed and the factor is 3.
#include "experiments/studies/verification/problem.hpp"
#include "reference_fem/verification/problems.hpp"

#include "analysis/statistics/grid_convergence.hpp"

namespace experiments {

using namespace reference_fem;

namespace {

constexpr double published_order = 1.786170, published_index_pct = 0.103083, published_factor = 1.25;

VerificationRow row_of(const RowQuantity& quantity, const std::string& unit, double value, double reference, double half_a_digit)
{
    return {.problem = "grid_convergence",
            .quantity = quantity,
            .elements = {.formulation = "two_grids"},
            .material = {"none"},
            .mesh = "ratio 2",
            .value = value,
            .reference = reference,
            .unit = unit,
            .source = "NPARC Alliance CFD Verification and Validation, Examining spatial (grid) convergence",
            .low = reference - half_a_digit,
            .high = reference + half_a_digit,
            .bound_from = "half of the last printed digit"};
}

}  // namespace

VerificationRows grid_convergence_rows(const Effort&)
{
    const analysis::GridConvergence grids = analysis::two_grids({0.97050, 0.96854}, 2.0, published_order);
    const double factor = analysis::grid_safety_factor / published_factor;
    return {row_of({"grid_convergence_index", "grid convergence index of the finer grid with the safety factor 3"}, "%",
                   100.0 * grids.bounds[0] / 0.97050, factor * published_index_pct, factor * 5e-7),
            row_of({"extrapolated_value", "extrapolated pressure recovery"}, "1", grids.extrapolated, 0.97130, 5e-6)};
}

}  // namespace experiments
