// A claim of volume and one walk by which it is judged, for tests of functions that write verdicts.
//   judge(test_support::volume_claim("volume is kept"), {.cases = {test_support::walk()}})
#pragma once

#include "analysis/verdicts/case_record.hpp"
#include "analysis/verdicts/claims.hpp"

#include <string>

namespace test_support {

inline analysis::Claim volume_claim(const std::string& statement)
{
    analysis::Claim claim;
    claim.id = "C02";
    claim.statement = statement;
    claim.place = "Sec. 4";
    claim.study = "volume";
    claim.metrics = {"volume_change_pct"};
    claim.deformer = "pbs";
    claim.expected = 0.5;
    claim.low = -0.5;
    claim.high = 0.5;
    return claim;
}

// Four frames, the third outside the bounds.
inline analysis::CaseRecord walk()
{
    analysis::CaseRecord walk;
    walk.scene = "walk";
    walk.deformer = "pbs";
    walk.run = "volume/walk";
    walk.frame = walk.time_s = walk.inverted_tets = {0, 1, 2, 3};
    walk.volume_change_pct = {0, -0.1, -0.9, -0.2};
    walk.volume_abs_change_pct = {0, 1, 2, 3};
    return walk;
}

}  // namespace test_support
