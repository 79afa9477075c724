// How far a nonlinear deformer may be from the equilibrium that it solves for, for tolerances. Newton's method ends
// where the norm of the residual r is at most t F, or at most 4 eps D |diag H|, the forces that the rounding of
// positions causes (reference_fem/newton/newton.hpp): t = 1e-8, F the sum over the terms of |gradient|, D the diagonal
// of the bounding box, H the Hessian. To first order the error of the unknowns is H^-1 r, so that |e| <= |r| /
// min|eigenvalue of H|, which also bounds the error of every vertex.
#pragma once

#include "experiments/deformers/fem/bone_attachment.hpp"
#include "reference_fem/attachment.hpp"
#include "reference_fem/verification/problems.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace test_support {

// |e| [m] in a pose whose root is not moved. F and H are those of the equilibrium near `solution` [m], #V x 3. Not for
// bound vertices.
inline double newton_error_m(const pbs::Character& character, const experiments::FemOptions& options,
                             const pbs::Pose& pose, const pbs::Positions& solution)
{
    using namespace reference_fem;
    const pbs::Positions& rest = character.mesh.rest;
    const experiments::BoneAttachment bones = bone_attachment(character, options);
    ElasticBody body(character.mesh,
                     {.model = options.model,
                      .element_order = options.element_order,
                      .formulation = options.formulation,
                      .young_pa = options.young_pa,
                      .poisson = options.poisson,
                      .density_kg_m3 = options.density_kg_m3},
                     bones.attachment);
    body.start_from(solution);
    const NewtonSummary newton = body.solve_at_once(targets(bones, rest, pose), options.gravity_m_s2);
    EXPECT_TRUE(newton.converged()) << name_of(newton.outcome);

    const HeldSpace held(character.mesh, options.element_order, options.density_kg_m3, bones.attachment);
    NodalMatrix hessian(held.space());
    ElasticPotential(held.space(), options.model, lame_parameters(options.young_pa, options.poisson),
                     options.formulation)
        .add_hessian(body.displacement(), Definiteness::as_it_is, hessian);
    held.springs().add_to(hessian);
    const double diagonal_m = (rest.colwise().maxCoeff() - rest.colwise().minCoeff()).norm();
    const double of_positions_n =
        4.0 * std::numeric_limits<double>::epsilon() * diagonal_m * hessian.matrix().diagonal().norm();
    const double residual_n =
        std::max(NewtonOptions().relative_tolerance * newton.iterations.back().force_scale_n, of_positions_n);
    return residual_n / spectrum(hessian.matrix(), held.prescribed()).smallest;
}

// The rounding of positions [m] that are taken into the frame of a bone and back: two motions (rounding_error.hpp), and
// two roundings of each of three coordinates, of the difference from rest and of its sum with the place at rest. No
// norm on the way exceeds that of the farthest.
inline double frame_rounding_m(const pbs::Positions& positions)
{
    const double farthest = positions.rowwise().norm().maxCoeff();
    return motion_error(2, farthest) + std::sqrt(3.0) * rounding_error(2, farthest);
}

}  // namespace test_support
