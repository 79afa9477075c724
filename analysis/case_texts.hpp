// Parts of sentences about one judged case, shared by its texts and its row. Figures have three digits, and what only rounding left over
// is 0.
#pragma once

#include "analysis/case_judgement.hpp"

namespace analysis {

std::string figure(double value);                                  // 0 below 5e-4 in size; nan for what is not a number
std::string bounds_text(const Interval& interval, double factor);  // " [5.1, 7.3]"; nothing for an interval without bounds
std::string share_text(const CaseJudgement& judgement);            // 0 % [0, 2.54] of 573 frames
std::string span_text(const CaseJudgement& judgement);             // -3.44 to -0.644 %
std::string angle_ranges(const CaseJudgement& judgement);          // 0 to 116, 120; nothing where it holds at none
std::string inverted_text(const CaseJudgement& judgement);         // " (inverted tets in 3 of the frames within)", or nothing

}  // namespace analysis
