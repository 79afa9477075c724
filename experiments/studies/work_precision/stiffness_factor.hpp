// theta: the factor on a deformer's stiffness at which its answer is nearest to the reference. One number for "too soft by 3.7".
//   const StiffnessFactor theta = nearest_factor([&](double factor) { return error_pct_with(factor); });
// The search tries the factors 1/16, 1/8, ..., 64. While the best one is the first or the last, it tries further factors, down to 1/4096
// and up to 4096. Then it narrows the bracket around the best factor by golden sections of the logarithm (J. Kiefer, Proc. AMS 4, 1953), so
// that theta is known to 5 % where the error has one minimum in the bracket.
#pragma once

#include "analysis/records/tables.hpp"

#include <functional>
#include <limits>
#include <optional>
#include <vector>

namespace experiments {

// found: a minimum between the factors tried. end_of_grid: nearest at 1/4096 or 4096, so that there is no minimum inside and no theta.
// highest_allowed: nearest at the largest stiffness that the deformer accepts, likewise. insensitive: the errors at all factors differ by
// less than a hundredth of the least one. not_finite: at no factor there is an answer.
enum class ThetaOutcome { found, end_of_grid, highest_allowed, insensitive, not_finite };

struct StiffnessFactor {
    ThetaOutcome outcome = ThetaOutcome::not_finite;
    std::optional<double> theta = {};      // where found
    std::optional<double> error_pct = {};  // the least one
    std::optional<double> error_at_1_pct = {};
    int tried = 0;                                   // factors
    double lowest_tried = 0.0, highest_tried = 0.0;  // of them
};

const std::vector<double>& factor_grid();
// error_pct: at a factor; nothing where there is no answer. highest: the largest factor that the deformer accepts.
StiffnessFactor nearest_factor(const std::function<std::optional<double>(double factor)>& error_pct,
                               double highest = std::numeric_limits<double>::infinity());

}  // namespace experiments

namespace analysis {

template <>
struct EnumNames<experiments::ThetaOutcome> {
    static constexpr std::array<std::pair<experiments::ThetaOutcome, const char*>, 5> table{
        {{experiments::ThetaOutcome::found, "found"},
         {experiments::ThetaOutcome::end_of_grid, "end_of_grid"},
         {experiments::ThetaOutcome::highest_allowed, "highest_allowed"},
         {experiments::ThetaOutcome::insensitive, "insensitive"},
         {experiments::ThetaOutcome::not_finite, "not_finite"}}};
};

}  // namespace analysis
