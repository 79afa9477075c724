// Whether a claim's verdict is another in other orders and precisions of projection: constraints that contradict each other settle on
// another limit in each order.
//   for (const OrderVerdict& other : judge_orders(claim, records)) fmt::print("{}: {}\n", name_of(other), text_of(other));
#pragma once

#include "analysis/verdict.hpp"

namespace analysis {

// One an order and precision among the records of claim.orders, in order of first appearance; each is judged on the scenes it was recorded
// on, beside the claim's own deformer (default variant) on the same scenes. None where claim.orders is empty.
std::vector<OrderVerdict> judge_orders(const Claim& claim, const Records& records);

std::string name_of(const OrderVerdict& verdict);  // plain f32
std::string measured_in(
    const OrderVerdict& verdict);                  // limb_twist up to 175 of 180 deg, limb_bend (-2.4 to 0 %): by the claim's own metric
std::string text_of(const OrderVerdict& verdict);  // the same verdict; or: not reproduced instead of reproduced only for (limb_bend)

// The same in plain f32, ordered f64; another in grouped f32: ...; empty for none.
std::string text_of(const std::vector<OrderVerdict>& verdicts);

}  // namespace analysis
