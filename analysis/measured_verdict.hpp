// The verdict of a claim that is judged by figures a study measured (rule = "measured").
#pragma once

#include "analysis/verdict.hpp"

namespace analysis {

// By subject: what stands before the first comma of a figure's `of`, the character. A subject holds where all its figures are whole,
// in part where of each of its quantities some are: a claim of several quantities asks for all of them. All subjects hold: reproduced; some
// hold or do in part: reproduced only for those; none: not reproduced. A planned run without record: not computable.
Verdict judge_measurements(const Claim& claim, const Records& records);

}  // namespace analysis
