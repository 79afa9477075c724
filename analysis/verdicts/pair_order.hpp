// Which of two results is closer to the exact solution, judged with references that have errors of their own.
//   const PairOrder order = order_of({error_a, error_b, distance_ab, bound});                      // with one reference
//   const PairDecision decision = decide({order_with_q_10, order_with_q_100, order_with_nu_049});  // with an ensemble of references
// For results A, B, a reference x and the exact solution x*, in any norm of an inner product,
//   |A - x*|^2 - |B - x*|^2 = |A - x|^2 - |B - x|^2 + 2 <A - B, x - x*>,
// so the order is certain if the measured difference of squares exceeds 2 |A - B| U, where U bounds |x - x*|. This is sharper than
// comparing the difference of the errors with 2 U, since |A - B| <= |A - x| + |B - x|.
#pragma once

#include "analysis/records/tables.hpp"

#include <vector>

namespace analysis {

enum class PairOrder {
    undecided,  // the error of the reference may reverse the order
    first_is_closer,
    second_is_closer,
};

// All in the same norm and unit. bound: of the reference's own error.
struct PairDistances {
    double first_error = 0.0, second_error = 0.0, distance = 0.0, bound = 0.0;
};

// undecided where a value is not finite.
PairOrder order_of(const PairDistances& pair);

enum class PairDecision {
    decided,          // each member of the ensemble decides, and they agree
    reference_error,  // no two members contradict each other, but a member does not decide
    models_disagree,  // two members decide for different results
};

// One order per member of the ensemble; reference_error if there is none.
PairDecision decide(const std::vector<PairOrder>& members);

template <>
struct EnumNames<PairDecision> {
    static constexpr std::array<std::pair<PairDecision, const char*>, 3> table{{{PairDecision::decided, "decided"},
                                                                                {PairDecision::reference_error, "reference_error"},
                                                                                {PairDecision::models_disagree, "models_disagree"}}};
};

}  // namespace analysis
