// The drift of momentum that rounding gives to projections which conserve it, for tolerances. A projection adds a
// distance of at most rounding_of(constraint).step to each of its vertices (projection_rounding.hpp); over all
// projections, the drift is then at most the sum of mass times step over the sum of mass times correction, and the
// angular drift the same with arms from the centre of mass, both by their definition
// (experiments/studies/momentum/momentum_drift.hpp). The sums themselves go through as many roundings as they have
// terms.
#pragma once

#include "experiments/studies/momentum/momentum_drift.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/solver/constraint_set.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "pbs/solver/projection.hpp"
#include "tests/support/projection_rounding.hpp"
#include "tests/support/rounding_error.hpp"

namespace test_support {

struct DriftRounding {
    double linear = 0.0, angular = 0.0;
    double of_a_pass = 0.0;  // linear; relative to the corrections of a whole pass, with the steps of its projections
};

// For stretch and volume constraints in double, with the masses that the projection knows.
inline DriftRounding drift_rounding(const pbs::Character& character, const pbs::Pose& pose,
                                    const pbs::PbsOptions& options, experiments::ProjectedClass projected)
{
    const auto set = pbs::make_constraint_set<double>(character.mesh, character.binding.distance, {}, options);
    const Eigen::Index vertices = character.mesh.rest.rows();
    const Eigen::VectorXd mass = options.masses == pbs::Masses::unit
                                     ? Eigen::VectorXd::Ones(vertices)
                                     : pbs::lumped_volumes(character.mesh.rest, character.mesh.tets);
    const pbs::Positions lbs = experiments::blended(character, pose);
    const pbs::Vec3 centre = lbs.transpose() * mass / mass.sum();
    const std::vector<double>& w = set.inverse_mass;
    double steps = 0.0, steps_arm = 0.0, corrections = 0.0, corrections_arm = 0.0, terms = 0.0;
    const auto add = [&]<std::size_t n>(const std::array<int, n>& vertex, const auto& step_of,
                                        const auto& project_corners) {
        std::array<pbs::Vec3, n> before, after;
        for (std::size_t i = 0; i < n; ++i) before[i] = after[i] = lbs.row(vertex[i]).transpose() - centre;
        const double step = step_of(before);
        project_corners(after);
        for (std::size_t i = 0; i < n; ++i) {
            const double m = mass(vertex[i]), arm = before[i].norm(), correction = (after[i] - before[i]).norm();
            steps += m * step, steps_arm += m * arm * step, corrections += m * correction,
                corrections_arm += m * arm * correction;
            terms += 1.0;
        }
    };
    if (projected == experiments::ProjectedClass::stretch)
        for (const auto& c : set.stretch) {
            const double w1 = w[c.vertex[0]], w2 = w[c.vertex[1]];
            add(
                c.vertex, [&](const auto& p) { return rounding_of(c, w1, w2, p[0], p[1]).step; },
                [&](auto& p) { project(c, w1, w2, p[0], p[1]); });
        }
    else
        for (const auto& c : set.volume) {
            const std::array of_corners = {w[c.vertex[0]], w[c.vertex[1]], w[c.vertex[2]], w[c.vertex[3]]};
            add(
                c.vertex, [&](const auto& p) { return rounding_of(c, of_corners, p).step; },
                [&](auto& p) {
                    project(c, of_corners[0], of_corners[1], of_corners[2], of_corners[3], p[0], p[1], p[2], p[3]);
                });
        }

    const auto projection = pbs::make_projection<double>(set, character.mesh.tets, options);
    pbs::Positions after = lbs;
    projection->load(lbs, pbs::posed_bind_points(character.binding, pose), centre);
    if (projected == experiments::ProjectedClass::stretch)
        projection->project_stretch_constraints();
    else
        projection->project_volume_constraints();
    projection->store(centre, after);
    const double of_pass = (after - lbs).rowwise().norm().dot(mass);
    const double of_sums = rounding_error(terms + 10.0, 1.0);
    return {steps / corrections + of_sums, steps_arm / corrections_arm + of_sums, steps / of_pass + of_sums};
}

}  // namespace test_support
