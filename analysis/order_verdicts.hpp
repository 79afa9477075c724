// Whether a claim's verdict changes with the order and precision of projection. Constraints that contradict each other converge to a
// different limit in each order.
//   for (const OrderVerdict& other : judge_orders(claim, records)) ...
#pragma once

#include "analysis/verdict.hpp"

namespace analysis {

// One verdict for each order and precision among the records of claim.orders, in order of first appearance. Each is judged on the scenes on
// which it was recorded, and so is the claim's own deformer (default variant). None if claim.orders is empty.
std::vector<OrderVerdict> judge_orders(const Claim& claim, const Records& records);

}  // namespace analysis
