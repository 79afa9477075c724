// The verdict on a claim that is judged by values that a study measured (rule = "measured").
#pragma once

#include "analysis/verdict.hpp"

namespace analysis {

// Values are grouped by subject: the field of the key that the claim names, mostly the body. A subject holds if all its values hold as a
// whole. It holds in part if some values of each of its quantities do, since a claim of several quantities requires all of them. The
// verdict is reproduced if all subjects hold, reproduced only for some if some hold or hold in part, and not reproduced if none does. If a
// planned run has no record, the verdict is not computable.
Verdict judge_measurements(const Claim& claim, const Records& records);

}  // namespace analysis
