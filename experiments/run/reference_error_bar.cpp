#include "experiments/run/reference_error_bar.hpp"

#include "analysis/statistics/grid_convergence.hpp"
#include "pbs/character/character.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/topology.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace experiments {
namespace {

constexpr double smallest_difference_pct = 1e-9;  // smaller differences, as in the rest pose, are rounding errors and show no order
constexpr std::array<double analysis::ErrorNorms::*, 3> norms = {&analysis::ErrorNorms::l2_pct, &analysis::ErrorNorms::joint_pct,
                                                                 &analysis::ErrorNorms::linf_m};

const char* why(FemAttachment attachment)
{
    if (attachment == FemAttachment::smooth)
        return "the density of the springs has no jump: the displacement converges in the L2 norm with order 2 for linear and 3 for "
               "quadratic elements, of which the lower one is used";
    return "the capsules' surface is followed by no face of a tet and the displacement's gradient jumps across it: the displacement "
           "lies in H^(3/2 - eps), its energy error falls with h^(1/2) and, by duality, its own with h, whatever the element order";
}

// The inverse mesh size, up to a factor that is the same for all meshes of a body.
double nodes_along(const pbs::Tets& tets, Eigen::Index vertices, int element_order, int refinements)
{
    const Eigen::Index nodes = element_order == 1 ? vertices : vertices + pbs::edges_of(tets).rows();
    return std::cbrt(static_cast<double>(nodes)) * std::pow(2.0, refinements);
}

nlohmann::json spread(std::vector<double> values)
{
    if (values.empty()) return nullptr;
    std::sort(values.begin(), values.end());
    return {{"least", values.front()}, {"median", values[values.size() / 2]}, {"largest", values.back()}};
}

}  // namespace

double convergence_order(FemAttachment attachment)
{
    return attachment == FemAttachment::smooth ? 2.0 : 1.0;
}

ReferenceErrorBar::ReferenceErrorBar(ErrorBar kind, const DeformerSpec& reference, const pbs::Character& character)
    : kind_(kind), attachment_(options_of<FemOptions>(reference).attachment), character_(character)
{
    const int order = options_of<FemOptions>(reference).element_order, other_order = 3 - order;
    add_solution(reference, order, 0);
    if (kind != ErrorBar::refined) add_solution(reference, other_order, 0);
    if (kind != ErrorBar::orders) add_solution(reference, order, 1);
    if (kind == ErrorBar::both) add_solution(reference, other_order, 1);
    std::stable_sort(solutions_.begin(), solutions_.end(),
                     [](const Solution& a, const Solution& b) { return a.nodes_along > b.nodes_along; });
    while (solutions_[reference_].deformer) ++reference_;
}

void ReferenceErrorBar::add_solution(const DeformerSpec& reference, int element_order, int refinements)
{
    const pbs::Stopwatch stopwatch;
    Solution solution;
    solution.element_order = element_order;
    solution.refinements = refinements;
    solution.nodes_along = nodes_along(character_.mesh.tets, character_.mesh.rest.rows(), element_order, refinements);
    if (!solutions_.empty()) {  // the first is the reference itself
        DeformerSpec spec = reference;
        options_of<FemOptions>(spec).element_order = element_order;
        if (refinements > 0) solution.character = std::make_shared<const pbs::Character>(pbs::refined(character_));
        solution.deformer = make_deformer(spec);
        solution.deformer->reset(solution.character ? *solution.character : character_);
        solution.seconds = stopwatch.seconds();
    }
    solutions_.push_back(std::move(solution));
}

void ReferenceErrorBar::advance(const pbs::Pose& pose, double dt_s)
{
    for (Solution& solution : solutions_) {
        if (!solution.deformer) continue;
        solution.step = solution.deformer->advance(pose, dt_s);
        solution.seconds += solution.step.seconds;
    }
}

std::optional<analysis::ErrorNorms> ReferenceErrorBar::bound(const pbs::Positions& reference, const FrameMeasurer& measurer)
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
    if (positions.size() == 4) return bound_of_four(positions, measurer);
    const analysis::ErrorNorms difference = measurer.difference(positions[0], positions[1]);
    analysis::ErrorNorms bounds;
    for (const auto norm : norms)
        bounds.*norm = analysis::two_fields(difference.*norm, ratios()[0], convergence_order(attachment_)).bounds[reference_];
    return bounds;
}

// positions: of the solutions, the finest first.
analysis::ErrorNorms ReferenceErrorBar::bound_of_four(const std::vector<pbs::Positions>& positions, const FrameMeasurer& measurer)
{
    const auto from_finest = [&](std::size_t i) { return measurer.difference(positions[i], positions.front()); };
    const auto place = [&](int element_order, int refinements) {
        const auto found = std::ranges::find_if(
            solutions_, [&](const Solution& one) { return one.element_order == element_order && one.refinements == refinements; });
        return static_cast<std::size_t>(found - solutions_.begin());
    };
    const analysis::ErrorNorms quadratic = from_finest(place(2, 0)), linear_refined = from_finest(place(1, 1)),
                               linear = from_finest(place(1, 0)), own = from_finest(reference_);
    const analysis::NestedOrder order =
        analysis::nested_order({linear.joint_pct, linear_refined.joint_pct, quadratic.joint_pct}, convergence_order(attachment_));
    frames_reliable_ += order.reliable;
    if (linear.l2_pct > smallest_difference_pct) observed_orders_.push_back(order.observed);
    analysis::ErrorNorms bounds;
    for (const auto norm : norms) bounds.*norm = own.*norm + order.bound(quadratic.*norm);
    return bounds;
}

std::vector<double> ReferenceErrorBar::ratios() const
{
    std::vector<double> ratios;
    for (std::size_t k = 1; k < solutions_.size(); ++k) ratios.push_back(solutions_[k - 1].nodes_along / solutions_[k].nodes_along);
    return ratios;
}

nlohmann::json ReferenceErrorBar::method() const
{
    const bool four = solutions_.size() == 4;
    nlohmann::json method = {
        {"error_bar", name_of(kind_)},
        {"source", four ? "observed order of nested solutions, safety factors of L. Eca, M. Hoekstra 2014; on the character's own vertices"
                        : "grid convergence index: P. J. Roache 1994, I. B. Celik et al. 2008; on the character's own vertices"},
        {"order", convergence_order(attachment_)},
        {"order_note", four ? "observed, but no higher than this" : "presumed"},
        {"order_because", why(attachment_)},
        {"safety_factor", 3.0},
        {"ratios", ratios()},
        {"frames", frames_},
        {"frames_without", frames_without_}};
    for (const Solution& solution : solutions_) {
        const pbs::Character& character = solution.character ? *solution.character : character_;
        nlohmann::json entry = {{"element_order", solution.element_order},
                                {"refinements", solution.refinements},
                                {"vertices", character.mesh.rest.rows()},
                                {"tets", character.mesh.tets.rows()},
                                {"is_reference", !solution.deformer}};
        if (solution.deformer) entry.update({{"seconds", solution.seconds}, {"record", solution.deformer->record()}});
        method["solutions"].push_back(entry);
    }
    if (!four) return method;
    method["safety_factor_of_reliable_order"] = 1.25;
    method["observed_order"] = spread(observed_orders_);
    method["frames_of_reliable_order"] = frames_reliable_;
    return method;
}

}  // namespace experiments
