// The verdict of a claim that is judged by figures a study measured (rule = "measured").
#pragma once

#include "analysis/verdict.hpp"

namespace analysis {

// Every figure of the claim's quantities whole is reproduced; some, reproduced only for those; none is not reproduced. In words by subject:
// what stands before the first comma of a figure's `of`, that is the character.
Verdict judge_measurements(const Claim& claim, const Records& records);

}  // namespace analysis
