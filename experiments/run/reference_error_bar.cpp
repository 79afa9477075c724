#include "experiments/run/reference_error_bar.hpp"

#include "analysis/field_convergence.hpp"
#include "analysis/grid_convergence.hpp"
#include "pbs/character/refined_character.hpp"
#include "pbs/geometry/stopwatch.hpp"
#include "pbs/geometry/tet_volume.hpp"
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

// The lumped volumes of the blended vertices; of all vertices where none is blended.
Eigen::VectorXd weights_at_joints(const pbs::Character& character)
{
    Eigen::VectorXd weights = pbs::lumped_volumes(character.mesh.rest, character.mesh.tets);
    const auto& blended = character.blended;
    if (std::find(blended.begin(), blended.end(), true) == blended.end()) return weights;
    for (Eigen::Index v = 0; v < weights.size(); ++v)
        if (!blended[v]) weights(v) = 0.0;
    return weights;
}

}  // namespace

double convergence_order(FemAttachment attachment)
{
    return attachment == FemAttachment::smooth ? 2.0 : 1.0;
}

ReferenceErrorBar::ReferenceErrorBar(ErrorBar kind, const DeformerSpec& reference, const pbs::Character& character)
    : kind_(kind), attachment_(options_of<FemOptions>(reference).attachment), character_(character), weights_(weights_at_joints(character))
{
    const int order = options_of<FemOptions>(reference).element_order, other_order = 3 - order;
    const bool graded_by_orders = kind == ErrorBar::orders || (kind == ErrorBar::both && order == 2);
    add_solution(reference, order, 0);
    if (graded_by_orders) add_solution(reference, other_order, 0);
    if (kind != ErrorBar::orders) add_solution(reference, order, 1);
    if (kind == ErrorBar::both && order == 1) add_solution(reference, other_order, 1);
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
    if (positions.size() == 3) return bound_of_three(positions, measurer);
    const analysis::ErrorNorms difference = measurer.difference(positions[0], positions[1]);
    analysis::ErrorNorms bounds;
    for (const auto norm : norms)
        bounds.*norm = analysis::two_fields(difference.*norm, ratios()[0], convergence_order(attachment_)).bounds[reference_];
    return bounds;
}

analysis::ErrorNorms ReferenceErrorBar::bound_of_three(const std::vector<pbs::Positions>& positions, const FrameMeasurer& measurer)
{
    std::vector<double> sizes;
    for (const Solution& solution : solutions_) sizes.push_back(1.0 / solution.nodes_along);
    const analysis::FieldConvergence fit = analysis::fit_fields(positions, sizes, convergence_order(attachment_), weights_);
    frames_reliable_ += fit.reliable;
    if (measurer.difference(positions[0], positions[2]).l2_pct > smallest_difference_pct) {
        if (!std::isnan(fit.observed_order)) observed_orders_.push_back(fit.observed_order);
        unexplained_.push_back(fit.unexplained);
    }
    analysis::ErrorNorms bounds;
    for (const auto norm : norms)
        bounds.*norm =
            analysis::bound_of(fit, positions, reference_, [&](const auto& a, const auto& b) { return measurer.difference(a, b).*norm; });
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
    const bool three = solutions_.size() == 3;
    nlohmann::json method = {
        {"error_bar", name_of(kind_)},
        {"source", three ? "least squares fit of fields: L. Eca, M. Hoekstra 2014; on the character's own vertices"
                         : "grid convergence index: P. J. Roache 1994, I. B. Celik et al. 2008; on the character's own vertices"},
        {"order", convergence_order(attachment_)},
        {"order_note", three ? "observed, but no higher than this" : "presumed"},
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
    if (!three) return method;
    method["safety_factor_of_reliable_order"] = 1.25;
    method["observed_order"] = spread(observed_orders_);
    method["frames_of_reliable_order"] = frames_reliable_;
    method["unexplained_share"] = spread(unexplained_);
    return method;
}

}  // namespace experiments
