// The report of the stiffness study: a page with every exponent and every value of the claim, and a short table for the terminal.
#pragma once

#include "analysis/verdicts/claims.hpp"
#include "experiments/studies/stiffness/stiffness_ratios.hpp"

#include <string>
#include <utility>
#include <vector>

namespace experiments {

using SweptRows = std::pair<Varied, std::vector<StiffnessRow>>;

std::string stiffness_markdown(const std::vector<SweptRows>& sweeps);

// The ratios of PBS at k_stretch 0.2, of the same with the exponent, and of XPBD at 30 kPa.
std::string stiffness_text(const std::vector<SweptRows>& sweeps);

// XPBD is a control. Its stiffness is a material's, so its values should stay within the bounds that the claim sets for PBS; those of XPBD
// that forgets its multipliers should not, which shows that the study can tell the difference. The text has, for each thing doubled, how
// many values stay; the page lists XPBD's values that do not stay.
std::string control_text(const std::vector<SweptRows>& sweeps, const analysis::Claim& claim);
std::string control_markdown(const std::vector<SweptRows>& sweeps, const analysis::Claim& claim);

}  // namespace experiments
