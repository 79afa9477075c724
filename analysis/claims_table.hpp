// The verdicts as a table for the terminal, a few lines a claim.
//   fmt::print("{}", claims_table(verdicts, 100, false));
#pragma once

#include "analysis/verdict.hpp"

namespace analysis {

// Columns claim, verdict, statement (with what was asked for) and what was found, wrapped so that no line is longer than `width`
// characters (below 60: 60); under it how many claims have which verdict. colours: green reproduced, yellow in part, red not, magenta
// inconsistent, grey otherwise. Each case's figures stand in claims_markdown.
std::string claims_table(const std::vector<Verdict>& verdicts, std::size_t width, bool colours);

}  // namespace analysis
