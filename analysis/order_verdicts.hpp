// Whether a claim's verdict is another in other orders and precisions of projection: constraints that contradict each other settle on
// another limit in each order.
//   for (const OrderVerdict& other : judge_orders(claim, records)) ...
#pragma once

#include "analysis/verdict.hpp"

namespace analysis {

// One for each order and precision among the records of claim.orders, in order of first appearance. Each is judged on the scenes that it
// was recorded on, and so is the claim's own deformer (default variant). None where claim.orders is empty.
std::vector<OrderVerdict> judge_orders(const Claim& claim, const Records& records);

}  // namespace analysis
