#include "experiments/studies/fit/converged_pbs.hpp"

#include "experiments/process/interruption.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/pbs_solver.hpp"

namespace experiments {
namespace {

constexpr int chunk = 100;  // iterations between two looks
constexpr double tolerance = 1e-6;

pbs::Positions lbs_positions(const pbs::Character& character, const pbs::Pose& pose)
{
    pbs::Positions positions;
    pbs::linear_blend_skinning(character.mesh.rest, character.weights, pose, positions);
    return positions;
}

}  // namespace

ConvergedPbs converge(const pbs::Character& character, const pbs::Pose& pose, pbs::PbsOptions options, int most_iterations)
{
    options.precision = pbs::Precision::f64;
    options.iterations = chunk;
    options.jiggle.reset();
    pbs::PbsSolver solver(character.mesh, character.binding.distance, {}, options);
    const pbs::Positions bind_points = pbs::posed_bind_points(character.binding, pose);
    const double diagonal_m = (character.mesh.rest.colwise().maxCoeff() - character.mesh.rest.colwise().minCoeff()).norm();

    // Nothing jiggles, so a step that starts where the last one ended goes on iterating.
    ConvergedPbs limit;
    limit.positions = lbs_positions(character, pose);
    while (limit.iterations < most_iterations && !limit.converged) {
        stop_if_interrupted();
        solver.advance(limit.positions, bind_points, 1.0);
        limit.iterations += chunk;
        limit.last_change_m = (solver.positions() - limit.positions).rowwise().norm().maxCoeff();
        limit.positions = solver.positions();
        limit.converged = limit.last_change_m <= tolerance * diagonal_m;
    }
    return limit;
}

pbs::Positions after_iterations(const pbs::Character& character, const pbs::Pose& pose, const pbs::PbsOptions& options)
{
    pbs::PbsSolver solver(character.mesh, character.binding.distance, {}, options);
    solver.advance(lbs_positions(character, pose), pbs::posed_bind_points(character.binding, pose), 1.0);
    return solver.positions();
}

}  // namespace experiments
