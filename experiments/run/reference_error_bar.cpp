#include "experiments/run/reference_error_bar.hpp"

#include "analysis/statistics/grid_convergence.hpp"
#include "pbs/geometry/cost.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace experiments {
namespace {

constexpr double smallest_difference_pct =
    1e-9;  // smaller differences, as in the rest pose, are rounding errors and show no order

}  // namespace

double convergence_order(FemAttachment attachment)
{
    return attachment == FemAttachment::smooth ? 2.0 : 1.0;
}

ReferenceErrorBar::ReferenceErrorBar(const DeformerSpec& reference, const pbs::Character& character)
    : attachment_(options_of<FemOptions>(reference).attachment),
      refined_(pbs::refined(character)),
      solutions_{{{2, &refined_}, {2, &character}, {1, &refined_}, {1, &character}}}
{
    for (Solution& solution : solutions_) {
        if (solution.character == &character &&
            solution.element_order == options_of<FemOptions>(reference).element_order)
            continue;
        const pbs::Stopwatch stopwatch;
        DeformerSpec spec = reference;
        options_of<FemOptions>(spec).element_order = solution.element_order;
        solution.deformer = make_deformer(spec);
        solution.deformer->reset(*solution.character);
        solution.seconds = stopwatch.seconds();
    }
}

void ReferenceErrorBar::advance(const pbs::Pose& pose, double dt_s)
{
    for (Solution& solution : solutions_) {
        if (!solution.deformer) continue;
        solution.step = solution.deformer->advance(pose, dt_s);
        solution.seconds += solution.step.seconds;
    }
}

void ReferenceErrorBar::give_up_when(const std::function<bool()>& is_over)
{
    for (Solution& solution : solutions_)
        if (solution.deformer) solution.deformer->give_up_when(is_over);
}

std::optional<analysis::ErrorNorms> ReferenceErrorBar::bound(const pbs::Positions& reference,
                                                             const FrameMeasurer& measurer)
{
    ++frames_;
    std::vector<pbs::Positions> positions;
    for (const Solution& solution : solutions_) {
        if (solution.deformer && solution.step.outcome != pbs::Outcome::finished) {
            ++frames_without_;
            return std::nullopt;
        }
        positions.push_back(solution.deformer ? solution.deformer->positions().topRows(reference.rows()) : reference);
    }
    const auto from_finest = [&](const pbs::Positions& coarser) {
        return measurer.difference(coarser, positions.front());
    };
    const analysis::ErrorNorms own = from_finest(reference), quadratic = from_finest(positions[1]),
                               linear_refined = from_finest(positions[2]), linear = from_finest(positions[3]);
    const analysis::NestedOrder order = analysis::nested_order(
        {linear.joint_pct, linear_refined.joint_pct, quadratic.joint_pct}, convergence_order(attachment_));
    frames_reliable_ += order.reliable;
    if (linear.l2_pct > smallest_difference_pct) observed_orders_.push_back(order.observed);
    return analysis::ErrorNorms{own.l2_pct + order.bound(quadratic.l2_pct),
                                own.joint_pct + order.bound(quadratic.joint_pct),
                                own.linf_m + order.bound(quadratic.linf_m)};
}

nlohmann::json ReferenceErrorBar::method() const
{
    nlohmann::json method = {{"error_bar", name_of(ErrorBar::both)},
                             {"source",
                              "observed order of nested solutions, safety factors of L. Eca, M. Hoekstra 2014; on the "
                              "character's own vertices"},
                             {"order", convergence_order(attachment_)},
                             {"safety_factor", 3.0},
                             {"safety_factor_of_reliable_order", 1.25},
                             {"frames", frames_},
                             {"frames_without", frames_without_},
                             {"frames_of_reliable_order", frames_reliable_}};
    if (!observed_orders_.empty()) {
        const auto [least, largest] = std::ranges::minmax(observed_orders_);
        method["observed_order"] = {{"least", least}, {"largest", largest}};
    }
    for (const Solution& solution : solutions_) {
        nlohmann::json entry = {{"element_order", solution.element_order},
                                {"refinements", solution.character == &refined_ ? 1 : 0},
                                {"vertices", solution.character->mesh.rest.rows()},
                                {"tets", solution.character->mesh.tets.rows()},
                                {"is_reference", !solution.deformer}};
        if (solution.deformer) entry.update({{"seconds", solution.seconds}, {"record", solution.deformer->record()}});
        method["solutions"].push_back(entry);
    }
    return method;
}

}  // namespace experiments
