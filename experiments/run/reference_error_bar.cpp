#include "experiments/run/reference_error_bar.hpp"

#include "analysis/grid_convergence.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "pbs/character/refined_character.hpp"
#include "pbs/geometry/stopwatch.hpp"
#include "pbs/geometry/topology.hpp"

#include <algorithm>
#include <cmath>

namespace experiments {
namespace {

constexpr double presumed_order = 1.0, factor_elsewhere = 3.0;
constexpr double smallest_difference_pct = 1e-9;  // smaller differences, as in the rest pose, are rounding errors and show no order
constexpr std::array<double analysis::ErrorNorms::*, 3> norms = {&analysis::ErrorNorms::l2_pct, &analysis::ErrorNorms::joint_pct,
                                                                 &analysis::ErrorNorms::linf_m};
constexpr std::array<const char*, 3> norm_names = {"l2", "joint", "linf"};

constexpr const char* why_order_1 =
    "the capsules' surface is followed by no face of a tet and the displacement's gradient jumps across it: the displacement lies in "
    "H^(3/2 - eps), its energy error falls with h^(1/2) and, by duality, its own with h, whatever the element order";

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

ReferenceErrorBar::ReferenceErrorBar(ErrorBar kind, const DeformerSpec& reference, const pbs::Character& character)
    : kind_(kind), character_(character)
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
    std::vector<analysis::ErrorNorms> differences = {measurer.difference(positions[0], positions[1])};
    if (positions.size() == 3) {
        differences.push_back(measurer.difference(positions[1], positions[2]));
        differences.push_back(measurer.difference(positions[0], positions[2]));
    }
    analysis::ErrorNorms bounds;
    for (std::size_t norm = 0; norm < norms.size(); ++norm) {
        std::vector<double> distances;
        for (const analysis::ErrorNorms& difference : differences) distances.push_back(difference.*norms[norm]);
        bounds.*norms[norm] = norm_bound(norm, distances);
    }
    return bounds;
}

std::vector<double> ReferenceErrorBar::ratios() const
{
    std::vector<double> ratios;
    for (std::size_t k = 1; k < solutions_.size(); ++k) ratios.push_back(solutions_[k - 1].nodes_along / solutions_[k].nodes_along);
    return ratios;
}

// distances: between the solutions 1 and 2; with three solutions also between 2 and 3, and between 1 and 3.
double ReferenceErrorBar::norm_bound(std::size_t norm, const std::vector<double>& distances)
{
    const std::vector<double> ratio = ratios();
    if (distances.size() == 1) return analysis::two_fields(distances[0], ratio[0], presumed_order).bounds[reference_];
    const analysis::FieldDifferences differences{distances[0], distances[1], distances[2]};
    const analysis::GridConvergence grids = analysis::three_fields(differences, {ratio[0], ratio[1]}, presumed_order);
    if (distances[2] > smallest_difference_pct) {
        observed_order_[norm].push_back(grids.observed_order);
        if (norm == 0) alignment_.push_back(differences.alignment());
    }
    frames_asymptotic_[norm] += grids.asymptotic;
    return grids.bounds[reference_] * (grids.asymptotic ? 1.0 : std::max(1.0, factor_elsewhere / grids.safety_factor));
}

nlohmann::json ReferenceErrorBar::method() const
{
    const bool three = solutions_.size() == 3;
    nlohmann::json method = {
        {"error_bar", name_of(kind_)},
        {"source", "grid convergence index: P. J. Roache 1994, I. B. Celik et al. 2008; on the character's own vertices"},
        {"order", presumed_order},
        {"order_note", three ? "observed, but no higher than this" : "presumed"},
        {"order_because", why_order_1},
        {"safety_factor", factor_elsewhere},
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
    method["safety_factor_in_asymptotic_range"] = 1.25;
    for (std::size_t norm = 0; norm < norms.size(); ++norm) {
        method["observed_order"][norm_names[norm]] = spread(observed_order_[norm]);
        method["frames_in_asymptotic_range"][norm_names[norm]] = frames_asymptotic_[norm];
    }
    method["alignment_of_differences"] = spread(alignment_);
    return method;
}

}  // namespace experiments
