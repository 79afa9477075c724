// Options of the finite element reference as a deformer.
#pragma once

#include "reference_fem/dynamics.hpp"
#include "reference_fem/formulation.hpp"
#include "reference_fem/linear_solver.hpp"
#include "reference_fem/model.hpp"

#include "pbs/geometry/types.hpp"

namespace experiments {

// How the bones hold the flesh. embedded: each bone is a rigid capsule inside the flesh, tied to it by springs. nodes: whole tets inside
// the capsule are prescribed. bind: the paper's bind constraint as an energy, for nonlinear models.
enum class FemAttachment { embedded, nodes, bind };

struct FemOptions {
    reference_fem::Model model = reference_fem::Model::linear;
    int element_order = 2;  // 1, 2
    reference_fem::Formulation formulation = reference_fem::Formulation::displacement;
    double young_pa = 1.0e5;
    double poisson = 0.45;
    double density_kg_m3 = 1000.0;
    pbs::Vec3 gravity_m_s2 = pbs::Vec3::Zero();
    reference_fem::Dynamics dynamics = reference_fem::Dynamics::quasi_static;
    double rayleigh_mass_1_s = 0.0;  // damping C = rayleigh_mass M + rayleigh_stiffness K(rest)
    double rayleigh_stiffness_s = 0.0;
    FemAttachment attachment = FemAttachment::embedded;
    double core_radius = 0.35;     // capsule radius over local limb radius
    double spring_factor = 1.0e4;  // q: springs of density q E / r^2, r the capsule's radius; doubling it changes no reported value
    reference_fem::LinearSolver solver = reference_fem::LinearSolver::cholmod;
    int most_newton_steps = 0;  // quasi-static: per stage of the way to a pose, which is then not reached; 0: no limit
    bool nested_start = false;  // nonlinear: the way to a far pose begins at the solution with fewer nodes (order 1, unrefined)
};

}  // namespace experiments
