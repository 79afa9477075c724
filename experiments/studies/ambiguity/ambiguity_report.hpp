// The changes as people read them.
#pragma once

#include "experiments/studies/ambiguity/claim_changes.hpp"

#include <string>

namespace experiments {

// At most 120 columns wide: one block per body, one line per reading, one column per claim. A cell is B over A of the value whose verdict
// flips, or else of the one that changes most. The lines below state by which readings each claim flips, and why others cannot touch it.
std::string claim_changes_text(const std::vector<ClaimChange>& changes);

}  // namespace experiments
