#include "experiments/deformers/fem/fem_deformer.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/stopwatch.hpp"

#include <algorithm>

namespace experiments {
namespace {

reference_fem::LinearOptions solver_options(const FemOptions& options)
{
    return {.element_order = options.element_order,
            .young_pa = options.young_pa,
            .poisson = options.poisson,
            .density_kg_m3 = options.density_kg_m3,
            .gravity_m_s2 = options.gravity_m_s2,
            .solver = options.solver};
}

}  // namespace

void FemDeformer::reset(const pbs::Character& character)
{
    if (options_.model != reference_fem::Model::linear || options_.formulation != reference_fem::Formulation::displacement ||
        options_.dynamics != reference_fem::Dynamics::quasi_static)
        throw pbs::InputError(character.name, 0, "fem", options_.name, "expected model linear: the others are declared, not yet built");
    character_ = &character;
    const auto& bones = character.skeleton.bones;
    root_ =
        static_cast<int>(std::find_if(bones.begin(), bones.end(), [](const pbs::Bone& bone) { return bone.parent < 0; }) - bones.begin());
    bones_ =
        options_.attachment == FemAttachment::embedded ? embedded_attachment(character, options_) : nodes_attachment(character, options_);
    elasticity_ = std::make_unique<reference_fem::LinearElasticity>(character.mesh, solver_options(options_), bones_.attachment);
    record_ = FemRecord(character, options_, bones_, elasticity_->setup().spring_tet);
    positions_ = character.mesh.rest;
}

pbs::StepSummary FemDeformer::advance(const pbs::Pose& pose, double)
{
    const pbs::Stopwatch stopwatch;
    const Eigen::Isometry3d& root = pose[root_];
    pbs::Pose relative = pose;
    for (Eigen::Isometry3d& bone : relative) bone = root.inverse() * bone;
    const pbs::Positions targets = spring_targets(bones_, relative);
    const reference_fem::SolveSummary solve = elasticity_->solve(targets, vertex_targets(bones_, character_->mesh.rest, relative),
                                                                 root.linear().transpose() * options_.gravity_m_s2);
    positions_ = (elasticity_->positions() * root.linear().transpose()).rowwise() + root.translation().transpose();
    const double seconds = stopwatch.seconds();
    record_.add_frame(relative, targets, elasticity_->spring_points_deformed(), solve);

    pbs::StepSummary summary;
    summary.outcome = solve.finite && positions_.allFinite() ? pbs::Outcome::finished : pbs::Outcome::not_finite;
    summary.seconds = seconds;
    return summary;
}

std::vector<bool> FemDeformer::prescribed() const
{
    if (!elasticity_ || options_.attachment == FemAttachment::embedded) return {};
    return elasticity_->prescribed_vertices();
}

nlohmann::json FemDeformer::record() const
{
    if (!elasticity_) return nullptr;
    return record_.to_json(elasticity_->setup());
}

}  // namespace experiments
