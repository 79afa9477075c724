#include "experiments/studies/stability/unequal_masses.hpp"

#include "experiments/studies/stability/stability_cell.hpp"

#include <cmath>
#include <random>

namespace experiments {
namespace {

template <typename Scalar>
std::unique_ptr<pbs::Projection<Scalar>> projection_of(const pbs::TetMesh& mesh, const Eigen::VectorXd& bind_distance,
                                                       const std::vector<bool>& jiggle_zone, const pbs::PbsOptions& options, double ratio)
{
    auto constraints = pbs::make_constraint_set<Scalar>(mesh, bind_distance, jiggle_zone, options);
    std::mt19937 engine(stability_seed);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (Scalar& inverse_mass : constraints.inverse_mass) inverse_mass = static_cast<Scalar>(std::pow(ratio, -share(engine)));
    return pbs::make_projection<Scalar>(std::move(constraints), mesh.tets, options);
}

}  // namespace

UnequalMasses::UnequalMasses(const pbs::TetMesh& mesh, const Eigen::VectorXd& bind_distance, const std::vector<bool>& jiggle_zone,
                             const pbs::PbsOptions& options, double ratio)
    : options_(options), particles_(mesh.rest, jiggle_zone, options)
{
    if (options.precision == pbs::Precision::f32)
        single_ = projection_of<float>(mesh, bind_distance, jiggle_zone, options_, ratio);
    else
        double_ = projection_of<double>(mesh, bind_distance, jiggle_zone, options_, ratio);
}

template <typename Scalar>
void UnequalMasses::project(pbs::Projection<Scalar>& projection, const pbs::Positions& bind_points)
{
    const pbs::Vec3 origin = pbs::local_origin<Scalar>(particles_.predicted());
    projection.load(particles_.predicted(), bind_points, origin);
    for (int iteration = 0; iteration < options_.iterations; ++iteration) {
        projection.project_bind_constraints();
        projection.project_stretch_constraints();
        projection.project_volume_constraints();
    }
    projection.store(origin, particles_.predicted());
}

pbs::StepSummary UnequalMasses::advance(const pbs::Positions& lbs_positions, const pbs::Positions& bind_points, double dt_s)
{
    particles_.predict(lbs_positions, dt_s);
    if (single_)
        project(*single_, bind_points);
    else
        project(*double_, bind_points);
    particles_.update(dt_s);
    pbs::StepSummary summary;
    summary.iterations = options_.iterations;
    if (!particles_.positions().allFinite()) summary.outcome = pbs::Outcome::not_finite;
    return summary;
}

}  // namespace experiments
