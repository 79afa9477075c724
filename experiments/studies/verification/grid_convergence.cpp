// The mathematics of the reference's error bar against a published example: pressure recovery on three grids (NPARC Alliance CFD
// Verification and Validation, tutorial "Examining spatial (grid) convergence", after P. J. Roache 1994).
#include "experiments/studies/verification/problem.hpp"
#include "reference_fem/verification/common.hpp"

#include "analysis/grid_convergence.hpp"

namespace experiments {

using namespace reference_fem;

namespace {

VerificationRow row_of(const RowQuantity& quantity, const std::string& unit, double value, double reference, double half_a_digit)
{
    return {.problem = "grid_convergence",
            .quantity = quantity,
            .elements = {.formulation = "three_grids"},
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
    const analysis::GridConvergence grids = analysis::three_grids({0.97050, 0.96854, 0.96178}, {2.0, 2.0}, 2.0);
    return {row_of({"observed_order", "observed order of pressure recovery"}, "1", grids.observed_order, 1.786170, 5e-7),
            row_of({"grid_convergence_index", "grid convergence index of the finest grid"}, "%", 100.0 * grids.bounds[0] / 0.97050,
                   0.103083, 5e-7),
            row_of({"extrapolated_value", "extrapolated pressure recovery"}, "1", grids.extrapolated, 0.97130, 5e-6)};
}

}  // namespace experiments
