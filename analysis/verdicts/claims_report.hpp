// Verdicts as files: claims.json holds the facts for programs, claims.md the most important of them as a table.
//   write_text_atomically(folder + "/claims.json", claims_json(verdicts, revision).dump(2) + "\n");
//   write_text_atomically(folder + "/claims.md", claims_markdown(verdicts));
#pragma once

#include "analysis/verdicts/verdict.hpp"

#include <nlohmann/json_fwd.hpp>

namespace analysis {

// {"schema": 2, "revision", "quantities": {NAME: {"title", "unit"}}, "claims": [{id, statement, place, study, rule, verdict, ...}]}. The
// document holds facts alone and no sentences. The fields of a key (case_record.hpp) are members of the object that they describe. Values
// that are not known or not finite are null. revision: the program that judged.
nlohmann::json claims_json(const std::vector<Verdict>& verdicts, const std::string& revision);

// A table with one row per claim: id, verdict, how many of its values hold, and the primary value with its interval, bound and case.
std::string claims_markdown(const std::vector<Verdict>& verdicts);

// The primary value in columns of text; all are empty if there is none.
struct PrimaryTexts {
    std::string quantity, value, interval, bound, of;  // volume_change_pct, share_of_frames; 0.42; [0.31, 0.5]; 0.95 to 1; human, 01_01
};
PrimaryTexts texts_of_primary(const Verdict& verdict);

// The verdicts as a table for the terminal, with a few lines per claim.
//   fmt::print("{}", claims_table(verdicts, 100, false));

// The columns are claim, verdict, statement and facts: how many values lie within the bound, and the primary value with its interval, bound
// and case. Lines are wrapped so that none is longer than `width` characters (below 60: 60). The last lines count the verdicts. colours:
// green for reproduced, yellow for reproduced in part, red for not reproduced, magenta for inconsistent, grey otherwise. claims.json holds
// all values.
std::string claims_table(const std::vector<Verdict>& verdicts, std::size_t width, bool colours);

}  // namespace analysis
