#include "experiments/studies/shared/posed_reference.hpp"

#include "experiments/deformers/registry.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/run/frame_measurement.hpp"
#include "experiments/run/reference_error_bar.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "pbs/character/bone_capsules.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>

namespace experiments {
namespace {

// Each step takes about 15 s and 5 GB on tets cut into eight. In a fold without contact their number has no limit. Measured: 53 steps on
// the human's crouch with Poisson's ratio 0.49, and 84 on the human standing with stiffer springs.
constexpr int most_newton_steps = 120;
constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

// Computes the volume ratios of the tets, counts the inverted ones and returns them.
std::vector<Eigen::Index> measure_volumes(const pbs::TetMesh& mesh, NestedSolution& solution)
{
    const Eigen::VectorXd ratios = pbs::tet_volumes(solution.positions, mesh.tets).cwiseQuotient(pbs::tet_volumes(mesh.rest, mesh.tets));
    solution.j_min = ratios.minCoeff(&solution.worst_tet);
    std::vector<Eigen::Index> inverted;
    for (Eigen::Index t = 0; t < ratios.size(); ++t)
        if (ratios(t) <= 0.0) inverted.push_back(t);
    solution.inverted_tets = static_cast<int>(inverted.size());
    return inverted;
}

}  // namespace

std::string worst_tet_of(const NestedSolution& solution)
{
    return fmt::format("worst tet {} of volume ratio {:.3g}, {} inverted", solution.worst_tet, solution.j_min, solution.inverted_tets);
}

DeformerSpec reference_flesh(const Scene& scene)
{
    const DeformerSpec* fem = find_deformer_with<FemOptions>(scene);
    if (!fem) throw pbs::InputError(scene.file, 0, "deformers.use", scene.name, "expected a [[fem]] deformer");
    DeformerSpec flesh = *fem;
    flesh.name = flesh.label = "neo_hookean";
    const auto& own = options_of<FemOptions>(*fem);
    flesh.options = FemOptions{.model = reference_fem::Model::neo_hookean,
                               .young_pa = own.young_pa,
                               .poisson = own.poisson,
                               .density_kg_m3 = own.density_kg_m3,
                               .attachment = FemAttachment::smooth,
                               .most_newton_steps = most_newton_steps};
    return flesh;
}

PosedReference::PosedReference(const pbs::Character& character, const DeformerSpec& spec, const pbs::Pose& pose, double time_step_s,
                               bool refines)
    : character_(character),
      label_(spec.label),
      error_metrics_(error_domain(character, {})),
      masked_(character.mesh.rest.rows(), false),
      bound_{not_known, not_known, not_known}
{
    const pbs::Character fine = refines ? pbs::refined(character) : pbs::Character();
    if (refines) {
        solve(spec, pose, time_step_s, {{fine, 2}, {fine, 1}, {character, 1}});
        solve(spec, pose, time_step_s, {{character, 2}});
        std::rotate(solutions_.begin() + 1, solutions_.end() - 1, solutions_.end());  // the finest first
    } else {
        solve(spec, pose, time_step_s, {{character, 2}, {character, 1}});
    }
    for (std::size_t i = 0; i < solutions_.size() && !which_; ++i)
        if (solutions_[i].lowest_det_f > 0.0) which_ = i;
    if (which_ && refines) observe_order(convergence_order(options_of<FemOptions>(spec).attachment));
}

// levels: the finest first, each of which sets out from the next one.
void PosedReference::solve(const DeformerSpec& spec, const pbs::Pose& pose, double time_step_s, const std::vector<Level>& levels)
{
    stop_if_interrupted();
    DeformerSpec nested = spec;
    auto& options = options_of<FemOptions>(nested);
    options.element_order = levels.front().element_order;
    options.nested_start = true;
    if (options.element_order == 1) options.formulation = reference_fem::Formulation::displacement;  // mean dilatation is the same there
    const std::unique_ptr<Deformer> deformer = make_deformer(nested);
    deformer->reset(levels.front().character);
    TriedSolution solution{deformer.get(), deformer->advance(pose, time_step_s)};
    for (const Level& level : levels) {
        if (!solution.deformer) break;
        const TriedSolution coarser = solution.deformer->facts()->fewer_nodes;
        solution.step.seconds -= coarser.step.seconds;
        add(solution, level);
        solution = coarser;
    }
}

void PosedReference::add(const TriedSolution& of, const Level& level)
{
    NestedSolution solution;
    solution.element_order = level.element_order;
    solution.refinements = level.character.refinements;
    solution.finished = of.step.outcome == pbs::Outcome::finished;
    solution.seconds = of.step.seconds;
    const pbs::Positions positions = last_state(*of.deformer);
    solution.positions = positions.topRows(character_.mesh.rest.rows());
    const nlohmann::json newton = of.deformer->record().at("newton");
    solution.newton_steps = newton.at("newton_steps").at("most");
    solution.projected = newton.at("projected_hessians");
    const std::vector<Eigen::Index> inverted = measure_volumes(character_.mesh, solution);
    if (solution.finished) {
        solution.lowest_det_f = of.deformer->facts()->lowest_det_f.value();
        for (const Eigen::Index tet : inverted)
            for (const int v : character_.mesh.tets.row(tet)) masked_[v] = true;
        const std::vector<bool> overlaps = pbs::OverlapMask(level.character).of(positions);
        for (std::size_t v = 0; v < masked_.size(); ++v) masked_[v] = masked_[v] || overlaps[v];
    }
    solutions_.push_back(std::move(solution));
}

void PosedReference::observe_order(double formal_order)
{
    if (!std::all_of(solutions_.begin() + 1, solutions_.end(), [](const NestedSolution& solution) { return solution.finished; })) return;
    constexpr std::size_t finest = 0, quadratic = 1, linear_refined = 2, linear = 3;
    const auto between = [&](std::size_t one, std::size_t other) {
        return distance(solutions_[one].positions, solutions_[other].positions);
    };
    const bool has_finest = solutions_[finest].finished;
    const std::size_t best = has_finest ? finest : quadratic;
    const double linear_pct = between(linear, best).joint_pct, refined_pct = between(linear_refined, best).joint_pct;
    order_ = has_finest ? analysis::nested_order({linear_pct, refined_pct, between(quadratic, finest).joint_pct}, formal_order)
                        : analysis::order_without_finest(linear_pct, refined_pct, formal_order);
    const analysis::ErrorNorms to_best = between(has_finest ? *which_ : linear_refined, best),
                               bounded = has_finest ? between(quadratic, finest) : between(linear, linear_refined);
    for (const auto norm : {&analysis::ErrorNorms::l2_pct, &analysis::ErrorNorms::joint_pct, &analysis::ErrorNorms::linf_m})
        bound_.*norm = to_best.*norm + order_->bound(bounded.*norm);
}

analysis::ErrorNorms PosedReference::error_on_whole_body(const pbs::Positions& positions) const
{
    return error_metrics_.measure(positions, reference().positions);
}

analysis::ErrorNorms PosedReference::distance(const pbs::Positions& one, const pbs::Positions& other) const
{
    return error_metrics_.measure(one, other, masked_);
}

std::vector<EnsembleMember> family()
{
    return {{.name = "smooth"},
            {.name = "stiffer_springs", .spring_factor = 100.0},
            {.name = "thinner_bones", .core_radius = 0.5},
            {.name = "stiffer_springs_thinner_bones", .spring_factor = 100.0, .core_radius = 0.5},
            {.name = "nu_0.3", .poisson = 0.3},
            {.name = "nu_0.49", .poisson = 0.49, .formulation = reference_fem::Formulation::mean_dilatation}};
}

std::size_t place_among_further(const std::string& member)
{
    const std::vector<EnsembleMember> all = family();
    return static_cast<std::size_t>(std::ranges::find(all, member, &EnsembleMember::name) - all.begin()) - 1;
}

const analysis::Columns<EnsembleMember>& family_member_columns()
{
    static const analysis::Columns<EnsembleMember> columns = analysis::Columns<EnsembleMember>{{"member", &EnsembleMember::name}} +
                                                             MEMBER_COLUMNS(EnsembleMember, spring_factor, core_radius, poisson);
    return columns;
}

RECORD_SETTINGS(EnsembleMember, name, spring_factor, core_radius, poisson, formulation)

DeformerSpec flesh_of(DeformerSpec flesh, const EnsembleMember& member)
{
    auto& options = options_of<FemOptions>(flesh);
    options.attachment = FemAttachment::smooth;
    options.spring_factor = member.spring_factor;
    options.core_radius = member.core_radius;
    options.poisson = member.poisson;
    options.formulation = member.formulation;
    return flesh;
}

}  // namespace experiments
