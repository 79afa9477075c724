#include "analysis/verdicts/pair_order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace analysis {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

}  // namespace

PairOrder order_of(const PairDistances& pair)
{
    const double first = pair.first_error.value_or(not_known), second = pair.second_error.value_or(not_known);
    const double gap = first * first - second * second;
    const double within = 2.0 * pair.distance.value_or(first + second) * pair.bound.value_or(not_known);
    if (!(std::abs(gap) > within) || !std::isfinite(gap)) return PairOrder::undecided;
    return gap < 0.0 ? PairOrder::first_is_closer : PairOrder::second_is_closer;
}

std::optional<double> shift_of_difference(const PairDistances& pair)
{
    if (!std::isfinite(pair.bound.value_or(not_known))) return std::nullopt;
    const double sum = pair.first_error.value_or(not_known) + pair.second_error.value_or(not_known);
    const double least_sum = sum - 2.0 * *pair.bound;  // of the distances to any point within the bound of the reference
    const double slope = least_sum > 0.0 ? std::min(2.0, 2.0 * pair.distance.value_or(sum) / least_sum) : 2.0;
    return slope * *pair.bound;
}

PairDecision decide(const std::vector<PairOrder>& members)
{
    const auto any = [&](PairOrder order) { return std::find(members.begin(), members.end(), order) != members.end(); };
    if (any(PairOrder::first_is_closer) && any(PairOrder::second_is_closer)) return PairDecision::models_disagree;
    return members.empty() || any(PairOrder::undecided) ? PairDecision::reference_error : PairDecision::decided;
}

}  // namespace analysis
