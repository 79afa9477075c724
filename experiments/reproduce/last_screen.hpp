// The last screen of `pbskin reproduce`: whether this machine repeats the record, the verdict on each claim, and how
// far the methods are from flesh. The kept record judges, for the default run measures a part of its cases; a full run
// judges by itself.
#pragma once

#include "analysis/verdicts/verdict.hpp"
#include "experiments/reproduce/comparison.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

struct LastScreen {
    std::string folder;                        // of the results
    std::vector<analysis::Verdict> here = {};  // from the results alone
    std::vector<std::string> studies = {};     // that were run
    std::vector<std::string> other_tets = {};  // bodies whose tets are not those of the record
    bool full = false;                         // all of their cases
};

// Writes claims.json, claims.md and, if there is a kept record, repeated.json into the folder, and prints the screen.
// Returns whether the results agree with the record.
bool show_last_screen(LastScreen screen);

// claims.json and claims.md.
void write_verdicts(const std::vector<analysis::Verdict>& verdicts, const std::string& folder);

}  // namespace experiments
