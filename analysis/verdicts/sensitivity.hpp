// On what a verdict depends: it is judged again without each body, and with other thresholds.
//   const Sensitivity found = sensitivity(claim, records);   // found.without_body, found.ranges
#pragma once

#include "analysis/verdicts/verdict.hpp"

namespace analysis {

// Without the cases of each body, among the claim's own and in every control; a control that was measured on this body
// alone keeps its cases. And for each end of a threshold, the range over which the verdict is the same while all else
// stays. A control with the claim's own thresholds has the other threshold, too. Between two neighbouring numbers of
// cases no verdict changes, so that the ends of a range are numbers of cases. Nothing for other rules than `cases`, and
// for verdicts that cannot be computed. Held-out values are no part of it.
Sensitivity sensitivity(const Claim& claim, const Records& records);

}  // namespace analysis
