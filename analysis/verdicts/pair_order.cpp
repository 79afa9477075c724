#include "analysis/verdicts/pair_order.hpp"

#include <algorithm>
#include <cmath>

namespace analysis {

PairOrder order_of(const PairDistances& pair)
{
    const double gap = pair.first_error * pair.first_error - pair.second_error * pair.second_error;
    if (!(std::abs(gap) > 2.0 * pair.distance * pair.bound) || !std::isfinite(gap)) return PairOrder::undecided;
    return gap < 0.0 ? PairOrder::first_is_closer : PairOrder::second_is_closer;
}

PairDecision decide(const std::vector<PairOrder>& members)
{
    const auto any = [&](PairOrder order) { return std::find(members.begin(), members.end(), order) != members.end(); };
    if (any(PairOrder::first_is_closer) && any(PairOrder::second_is_closer)) return PairDecision::models_disagree;
    return members.empty() || any(PairOrder::undecided) ? PairDecision::reference_error : PairDecision::decided;
}

}  // namespace analysis
