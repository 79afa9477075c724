// Verdicts as files: claims.json for programs, claims.md for pages.
//   write_text_atomically(folder + "/claims.json", claims_json(verdicts).dump(2) + "\n");
//   write_text_atomically(folder + "/claims.md", claims_markdown(verdicts));
#pragma once

#include "analysis/verdict.hpp"

#include <nlohmann/json_fwd.hpp>

namespace analysis {

// {"schema": 1, "claims": [{id, statement, place, study, expected, verdict, text, measured, interval, interval_of, runs, cases, beside,
// orders}]};
// figures that are not known are null.
nlohmann::json claims_json(const std::vector<Verdict>& verdicts);

// A table with the columns id, statement, expected, measured, interval, verdict, runs: one row a claim, and under it one a case, which has
// its name, metric and where the claim holds in the columns statement, expected and verdict.
std::string claims_markdown(const std::vector<Verdict>& verdicts);

std::string expected_text(const Claim& claim);  // 14 % (12 to 16 %)

}  // namespace analysis
