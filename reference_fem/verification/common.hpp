// Parts that the verification problems share.
#pragma once

#include "reference_fem/boundary_value_problem.hpp"
#include "reference_fem/verification/effort.hpp"

namespace reference_fem {

VerificationRows laws_rows(const Effort& effort);
VerificationRows patch_test_rows(const Effort& effort);
VerificationRows manufactured_solution_rows(const Effort& effort);
VerificationRows own_weight_rows(const Effort& effort);
VerificationRows cantilever_rows(const Effort& effort);
VerificationRows gravity_cantilever_rows(const Effort& effort);
VerificationRows torsion_rows(const Effort& effort);
VerificationRows thick_sphere_rows(const Effort& effort);
VerificationRows cooks_membrane_rows(const Effort& effort);
VerificationRows cooks_membrane_finite_strain_rows(const Effort& effort);
VerificationRows locking_rows(const Effort& effort);
VerificationRows twisted_beam_rows(const Effort& effort);
VerificationRows thick_plate_rows(const Effort& effort);
VerificationRows half_turn_rows(const Effort& effort);
VerificationRows dynamics_rows(const Effort& effort);
VerificationRows moving_skeleton_rows(const Effort& effort);
VerificationRows distributed_rows(const Effort& effort);

// The material that the solver receives in place of `material`: the same, unless the effort asks for an error in lambda.
ElasticMaterial solver_material(const Effort& effort, const ElasticMaterial& material);

RowElements elements_of(int order, Formulation formulation = Formulation::displacement);
RowMaterial material_of(const std::string& law, double poisson);  // {"neo_hookean", 0.3}
RowMaterial linear_material(double poisson);                      // {"linear", 0.3}
std::string identifier_of(const std::string& words);              // Newmark, step 40 ms: newmark_step_40_ms
double order_between(double coarse, double fine);                 // of errors on two meshes, one twice as fine

// R. MacNeal, R. Harder, A proposed standard set of problems to test finite element accuracy, Finite Elements in Analysis and Design 1
// (1985) 3-20, Table 13: an element that is within 2 % of the reference is given an A.
inline constexpr double grade_a = 0.02;
inline const std::string grade_a_text = "within 2 %: grade A of MacNeal and Harder 1985";
void bound_by_grade_a(VerificationRow& row);

}  // namespace reference_fem
