// theta: the factor on a deformer's stiffness at which its answer is nearest to the reference. One number for "too soft by 3.7".
//   const StiffnessFactor theta = nearest_factor([&](double factor) { return error_pct_with(factor); });
// The search tries the factors 1/16, 1/8, ..., 64 and then narrows the bracket around the best of them by golden sections of the logarithm
// (J. Kiefer, Proc. AMS 4, 1953), so that theta is known to 5 % where the error has one minimum in the bracket.
#pragma once

#include "analysis/records/typed_table.hpp"

#include <functional>
#include <optional>
#include <vector>

namespace experiments {

// found: inside the grid. end_of_grid: nearest at the first or last factor, so that theta may lie beyond it. insensitive: the errors over
// the grid differ by less than a hundredth of the least one. not_finite: at no factor there is an answer.
enum class ThetaOutcome { found, end_of_grid, insensitive, not_finite };

struct StiffnessFactor {
    ThetaOutcome outcome = ThetaOutcome::not_finite;
    std::optional<double> theta = {};  // where found or at the end of the grid
    std::optional<double> error_pct = {}, error_at_1_pct = {};
    int tried = 0;  // factors
};

const std::vector<double>& factor_grid();
// error_pct: at a factor; nothing where there is no answer. highest: of the factors.
StiffnessFactor nearest_factor(const std::function<std::optional<double>(double factor)>& error_pct, double highest = 64.0);

}  // namespace experiments

namespace analysis {

template <>
struct EnumNames<experiments::ThetaOutcome> {
    static constexpr std::array<std::pair<experiments::ThetaOutcome, const char*>, 4> table{
        {{experiments::ThetaOutcome::found, "found"},
         {experiments::ThetaOutcome::end_of_grid, "end_of_grid"},
         {experiments::ThetaOutcome::insensitive, "insensitive"},
         {experiments::ThetaOutcome::not_finite, "not_finite"}}};
};

}  // namespace analysis
