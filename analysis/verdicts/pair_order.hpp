// Which of two results is closer to the exact solution, judged with references that have errors of their own. Every study that decides
// pairs uses this rule.
//   const PairOrder order = order_of({error_a, error_b, distance_ab, bound});                      // with one reference
//   const PairDecision decision = decide({order_with_q_10, order_with_q_100, order_with_nu_049});  // with an ensemble of references
// For results A, B, a reference x and the exact solution x*, in any norm of an inner product,
//   |A - x*|^2 - |B - x*|^2 = |A - x|^2 - |B - x|^2 + 2 <A - B, x - x*>,
// so the order is certain if the measured difference of squares exceeds 2 |A - B| U, where U bounds |x - x*|. This is sharper than
// comparing the difference of the errors with 2 U, since |A - B| <= |A - x| + |B - x|. Where the distance |A - B| is not known, this sum
// takes its place, and the two rules are the same.
#pragma once

#include "analysis/records/tables.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace analysis {

enum class PairOrder {
    undecided,  // the error of the reference may reverse the order
    first_is_closer,
    second_is_closer,
};

inline constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

// All in the same norm and unit. A value that is not known makes the pair undecided, except for the distance.
struct PairDistances {
    std::optional<double> first_error = {}, second_error = {};
    std::optional<double> distance = {};  // between the two results; not known: the sum of the errors
    std::optional<double> bound = {};     // of the reference's own error
};

// undecided where a value is not finite.
inline PairOrder order_of(const PairDistances& pair)
{
    const double first = pair.first_error.value_or(not_measured), second = pair.second_error.value_or(not_measured);
    const double gap = first * first - second * second;
    const double within = 2.0 * pair.distance.value_or(first + second) * pair.bound.value_or(not_measured);
    if (!(std::abs(gap) > within) || !std::isfinite(gap)) return PairOrder::undecided;
    return gap < 0.0 ? PairOrder::first_is_closer : PairOrder::second_is_closer;
}

// By how much the reference's own error may change the difference of the two errors: for a mean of such differences, which no order of
// single pairs decides. It is at most U times the largest distance between the two unit vectors that point from A and from B to the
// reference, which is at most 2 and at most 2 |A - B| / (e_A + e_B) (C. Dunkl, K. Williams, A simple norm inequality, American Mathematical
// Monthly 71, 1964). The errors e_A and e_B are at least the measured ones less U. Nothing where the bound is not known or not finite.
inline std::optional<double> shift_of_difference(const PairDistances& pair)
{
    if (!std::isfinite(pair.bound.value_or(not_measured))) return std::nullopt;
    const double sum = pair.first_error.value_or(not_measured) + pair.second_error.value_or(not_measured);
    const double least_sum = sum - 2.0 * *pair.bound;  // of the distances to any point within the bound of the reference
    const double slope = least_sum > 0.0 ? std::min(2.0, 2.0 * pair.distance.value_or(sum) / least_sum) : 2.0;
    return slope * *pair.bound;
}

// The order of two means over several cases, with the mean difference of the errors and the mean shift of the differences; of one case,
// its order.
inline PairOrder order_of_means(const std::vector<PairDistances>& cases)
{
    if (cases.size() == 1) return order_of(cases.front());
    double difference = 0.0, shift = 0.0;
    for (const PairDistances& pair : cases) {
        difference += pair.first_error.value_or(not_measured) - pair.second_error.value_or(not_measured);
        shift += shift_of_difference(pair).value_or(not_measured);
    }
    if (!(std::abs(difference) > shift) || !std::isfinite(difference)) return PairOrder::undecided;
    return difference < 0.0 ? PairOrder::first_is_closer : PairOrder::second_is_closer;
}

enum class PairDecision {
    decided,          // each member of the ensemble decides, and they agree
    reference_error,  // no two members contradict each other, but a member does not decide
    models_disagree,  // two members decide for different results
};

// One order per member of the ensemble; reference_error if there is none.
inline PairDecision decide(const std::vector<PairOrder>& members)
{
    const auto any = [&](PairOrder order) { return std::find(members.begin(), members.end(), order) != members.end(); };
    if (any(PairOrder::first_is_closer) && any(PairOrder::second_is_closer)) return PairDecision::models_disagree;
    return members.empty() || any(PairOrder::undecided) ? PairDecision::reference_error : PairDecision::decided;
}

template <>
struct EnumNames<PairOrder> {
    static constexpr std::array<std::pair<PairOrder, const char*>, 3> table{{{PairOrder::undecided, "undecided"},
                                                                             {PairOrder::first_is_closer, "first_is_closer"},
                                                                             {PairOrder::second_is_closer, "second_is_closer"}}};
};
template <>
struct EnumNames<PairDecision> {
    static constexpr std::array<std::pair<PairDecision, const char*>, 3> table{{{PairDecision::decided, "decided"},
                                                                                {PairDecision::reference_error, "reference_error"},
                                                                                {PairDecision::models_disagree, "models_disagree"}}};
};

}  // namespace analysis
