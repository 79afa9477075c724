// One judged case as a row of a table: what was measured, how sure that is, and where the claim holds.
#pragma once

#include "analysis/case_judgement.hpp"

namespace analysis {

// Texts, one a column.
struct CaseRow {
    std::string name;      // human_01_01, limb_twist (jiggle)
    std::string measured;  // mean -1.33 %, -3.44 to -0.644 %
    std::string interval;  // 0 % [0, 2.54] of 573 frames; of a sweep: none
    std::string holds;     // yes; no; at 0 to 175 of 180 deg (inverted tets in 3 of the frames within)
};
// The claim must be the one it was judged by: its rule decides what the interval is of.
CaseRow case_row(const Claim& claim, const CaseJudgement& judgement);

}  // namespace analysis
