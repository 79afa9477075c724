// Verdicts as files: claims.json holds the facts for programs, claims.md the most important of them as a table.
//   write_text_atomically(folder + "/claims.json", claims_json(verdicts, revision).dump(2) + "\n");
//   write_text_atomically(folder + "/claims.md", claims_markdown(verdicts));
#pragma once

#include "analysis/verdict.hpp"

#include <nlohmann/json_fwd.hpp>

namespace analysis {

// {"schema": 2, "revision", "quantities": {NAME: {"title", "unit"}}, "claims": [{id, statement, place, study, rule, verdict, ...}]}. The
// document holds facts alone and no sentences. The fields of a key (case_key.hpp) are members of the object that they describe. Values that
// are not known or not finite are null. revision: the program that judged.
nlohmann::json claims_json(const std::vector<Verdict>& verdicts, const std::string& revision);

// A table with one row per claim: id, verdict, how many of its values hold, and the primary value with its interval, bound and case.
std::string claims_markdown(const std::vector<Verdict>& verdicts);

// The primary value in columns of text; all are empty if there is none.
struct PrimaryTexts {
    std::string quantity, value, interval, bound, of;  // volume_change_pct, share_of_frames; 0.42; [0.31, 0.5]; 0.95 to 1; human, 01_01
};
PrimaryTexts texts_of_primary(const Verdict& verdict);

}  // namespace analysis
