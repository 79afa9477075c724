// The verdicts as a table for the terminal, a few lines a claim.
//   fmt::print("{}", claims_table(verdicts, 100, false));
#pragma once

#include "analysis/verdict.hpp"

namespace analysis {

// Columns claim, verdict, statement and facts: how many values lie within the bound, and the primary value with its interval, bound and
// case. Wrapped so that no line is longer than `width` characters (below 60: 60). The last lines count the verdicts. colours: green for
// reproduced, yellow in part, red not, magenta inconsistent, grey otherwise. claims.json holds all values.
std::string claims_table(const std::vector<Verdict>& verdicts, std::size_t width, bool colours);

}  // namespace analysis
