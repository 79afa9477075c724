// The verdict of a claim that is judged by values that a study measured (rule = "measured").
#pragma once

#include "analysis/verdict.hpp"

namespace analysis {

// By subject: the field of the key that the claim names, mostly the body. A subject holds where all its values are whole, and in part where
// some values of each of its quantities are: a claim of several quantities asks for all of them. All subjects hold: reproduced; some
// hold or do in part: reproduced only for those; none: not reproduced. A planned run without record: not computable.
Verdict judge_measurements(const Claim& claim, const Records& records);

}  // namespace analysis
