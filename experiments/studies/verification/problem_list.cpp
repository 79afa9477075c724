#include "experiments/studies/verification/problem.hpp"
#include "reference_fem/verification/problems.hpp"

namespace experiments {

using namespace reference_fem;

const std::vector<VerificationProblem>& verification_problems()
{
    static const std::vector<VerificationProblem> verification_problems = {
        {"laws", 1.0, 1.0, laws_rows},
        {"patch_test", 1.0, 1.0, patch_test_rows},
        {"manufactured_solution", 3.0, 30.0, manufactured_solution_rows},
        {"own_weight", 1.0, 1.0, own_weight_rows},
        {"cantilever", 5.0, 20.0, cantilever_rows},
        {"gravity_cantilever", 3.0, 3.0, gravity_cantilever_rows},
        {"torsion", 3.0, 30.0, torsion_rows},
        {"thick_sphere", 3.0, 30.0, thick_sphere_rows},
        {"cooks_membrane", 5.0, 6.0, cooks_membrane_rows},
        {"cooks_membrane_finite_strain", 8.0, 60.0, cooks_membrane_finite_strain_rows},
        {"twisted_beam", 2.0, 10.0, twisted_beam_rows},
        {"half_turn", 10.0, 30.0, half_turn_rows},
        {"thick_plate", 4.0, 20.0, thick_plate_rows},
        {"locking", 15.0, 60.0, locking_rows},
        {"pbs_locking", 5.0, 40.0, pbs_locking_rows},
        {"attached_limb", 15.0, 15.0, attached_limb_rows},
        {"nested_convergence", 6.0, 6.0, nested_convergence_rows},
        {"dynamics", 2.0, 8.0, dynamics_rows},
        {"moving_skeleton", 2.0, 2.0, moving_skeleton_rows},
        {"contact", 10.0, 40.0, contact_rows},
        {"calculix", 15.0, 20.0, calculix_rows},
    };
    return verification_problems;
}

}  // namespace experiments

const std::vector<experiments::VerificationProblem>* pbskin_verification_problems()
{
    return &experiments::verification_problems();
}
