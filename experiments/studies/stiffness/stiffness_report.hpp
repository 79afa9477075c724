// What the stiffness study tells: a page with every exponent and every figure of the claim, and a short table for the terminal.
#pragma once

#include "analysis/claims.hpp"
#include "experiments/studies/stiffness/stiffness_ratios.hpp"

#include <string>
#include <utility>
#include <vector>

namespace experiments {

using SweptRows = std::pair<Varied, std::vector<StiffnessRow>>;

// Columns: varied, case, first, last, points, left_out, exponent, exponent_low, exponent_high.
analysis::CsvTable exponents_table(const std::vector<SweptRows>& sweeps);
std::string stiffness_markdown(const std::vector<SweptRows>& sweeps);

// A line a body and load; for one doubling of each thing, PBS at k_stretch 0.2, with the exponent, XPBD at 30 kPa.
std::string stiffness_text(const std::vector<SweptRows>& sweeps);

// Whether the control is one: XPBD's stiffness is a material's, so its figures should stay within the bounds that the claim sets PBS. For
// each thing doubled how many do, from least to most, and where the farthest is; the same of XPBD whose multipliers are forgotten, which
// should not, so that the study is seen to see it. A list of all of XPBD's that do not, for the page.
std::string control_text(const std::vector<SweptRows>& sweeps, const analysis::Claim& claim);
std::string control_markdown(const std::vector<SweptRows>& sweeps, const analysis::Claim& claim);

}  // namespace experiments
