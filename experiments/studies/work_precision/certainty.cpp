#include "experiments/studies/work_precision/certainty.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace experiments {
namespace {

using analysis::PairOrder;

PairOrder order_by(std::optional<double> nearer_pct, std::optional<double> other_pct, std::optional<double> bound_pct)
{
    constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
    const double one = nearer_pct.value_or(not_known), other = other_pct.value_or(not_known);
    return analysis::order_of({one, other, one + other, bound_pct.value_or(not_known)});
}

std::string joined(const std::vector<std::string>& names)
{
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

}  // namespace

std::string Decision::remark() const
{
    return is_decided() ? "" : " [undecided: " + reason + "]";
}

Decision decision_on(const Diagram& diagram, const DiagramPoint& nearer, const DiagramPoint& other)
{
    std::vector<PairOrder> orders = {order_by(nearer.error_pct, other.error_pct, diagram.reference_error_pct)};
    std::vector<std::string> silent, contrary;  // further references that do not decide, and that decide for the other point
    const std::vector<EnsembleMember> all = family();
    for (std::size_t m = 0; m < diagram.members.size(); ++m) {
        if (!diagram.members[m].takes_part) continue;
        orders.push_back(order_by(nearer.members[m], other.members[m], diagram.members[m].bound_pct));
        if (orders.back() == PairOrder::undecided) silent.push_back(all[m + 1].name);
        if (orders.back() == PairOrder::second_is_closer) contrary.push_back(all[m + 1].name);
    }
    Decision decision{analysis::decide(orders), "", static_cast<int>(orders.size())};
    if (!contrary.empty()) {
        decision.decision = analysis::PairDecision::models_disagree;
        decision.reason = "the order is the other way round for " + joined(contrary);
    } else if (!diagram.reference_error_pct) {
        decision.reason = "the reference's own error is not known";
    } else if (orders.front() == PairOrder::undecided) {
        decision.reason = fmt::format("within the reference's own error of up to {:.2g} %", *diagram.reference_error_pct);
    } else if (!silent.empty()) {
        decision.reason = "not decided by " + joined(silent) + ", by their own error or because they were not reached";
    }
    return decision;
}

std::optional<Decision> decision_from(const Diagram& diagram, const DeformerGroup& one, const DeformerGroup& other, double from_ms)
{
    std::vector<std::string> both = one.deformers;
    both.insert(both.end(), other.deformers.begin(), other.deformers.end());
    std::vector<std::size_t> indices;
    std::optional<Decision> worst;
    for (const analysis::WorkPrecision& at : diagram.of(both, indices)) {
        const DiagramPoint *nearer = best_of(diagram, one, at.cost), *than = best_of(diagram, other, at.cost);
        if (at.cost < from_ms || !nearer || !than) continue;
        const Decision decision = decision_on(diagram, *nearer, *than);
        if (!worst || decision.decision > worst->decision) worst = decision;
    }
    return worst;
}

}  // namespace experiments
