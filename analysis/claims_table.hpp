// The verdicts as a table for the terminal, with a few lines per claim.
//   fmt::print("{}", claims_table(verdicts, 100, false));
#pragma once

#include "analysis/verdict.hpp"

namespace analysis {

// The columns are claim, verdict, statement and facts: how many values lie within the bound, and the primary value with its interval, bound
// and case. Lines are wrapped so that none is longer than `width` characters (below 60: 60). The last lines count the verdicts. colours:
// green for reproduced, yellow for reproduced in part, red for not reproduced, magenta for inconsistent, grey otherwise. claims.json holds
// all values.
std::string claims_table(const std::vector<Verdict>& verdicts, std::size_t width, bool colours);

}  // namespace analysis
