#include "experiments/deformers/fem/fem_deformers.hpp"

#include "pbs/geometry/cost.hpp"
#include "pbs/skinning/pose_path.hpp"

#include <algorithm>

namespace experiments {
namespace {

reference_fem::LinearOptions linear_options(const FemOptions& options)
{
    return {.element_order = options.element_order,
            .young_pa = options.young_pa,
            .poisson = options.poisson,
            .density_kg_m3 = options.density_kg_m3,
            .gravity_m_s2 = options.gravity_m_s2,
            .solver = options.solver,
            .formulation = options.formulation};
}

}  // namespace

void LinearFemDeformer::reset(const pbs::Character& character)
{
    character_ = &character;
    bones_ = bone_attachment(character, options_);
    elasticity_ = std::make_unique<reference_fem::LinearElasticity>(character.mesh, linear_options(options_), bones_.attachment);
    record_ = FemRecord(character, options_, bones_, elasticity_->setup().spring_tet);
    frames_not_finite_ = 0;
    largest_residual_ = 0.0;
    most_iterations_ = 0;
    positions_ = character.mesh.rest;
}

pbs::StepSummary LinearFemDeformer::advance(const pbs::Pose& pose, double)
{
    const pbs::Stopwatch stopwatch;
    const pbs::RootFrame frame(character_->skeleton, pose);
    const reference_fem::Targets held = targets(bones_, character_->mesh.rest, frame.pose());
    const reference_fem::SolveSummary solve = elasticity_->solve(held.springs, held.vertices, frame.from_world(options_.gravity_m_s2));
    positions_ = frame.to_world(elasticity_->positions());

    pbs::StepSummary summary;
    summary.outcome = solve.finite && positions_.allFinite() ? pbs::Outcome::finished : pbs::Outcome::not_finite;
    summary.seconds = stopwatch.seconds();
    summary.work.linear_solves = 1;

    record_.add_frame(frame.pose());
    largest_residual_ = std::max(largest_residual_, solve.residual);
    most_iterations_ = std::max(most_iterations_, solve.iterations);
    if (solve.finite)
        record_.add_grip(held.springs, (held.springs - elasticity_->spring_points_deformed()).rowwise().norm());
    else
        ++frames_not_finite_;
    return summary;
}

std::vector<bool> LinearFemDeformer::prescribed() const
{
    if (!elasticity_ || options_.attachment != FemAttachment::nodes) return {};
    return elasticity_->prescribed_vertices();
}

nlohmann::json LinearFemDeformer::record() const
{
    if (!elasticity_) return nullptr;
    nlohmann::json json = record_.to_json(elasticity_->setup());
    json.update({{"frames_not_finite", frames_not_finite_}, {"largest_residual", largest_residual_}});
    if (options_.solver == reference_fem::LinearSolver::cg_ml) json["most_iterations"] = most_iterations_;
    return json;
}

}  // namespace experiments
