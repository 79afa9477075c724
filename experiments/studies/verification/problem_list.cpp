#include "experiments/studies/verification/problem.hpp"
#include "reference_fem/verification/common.hpp"

namespace experiments {

using namespace reference_fem;

const std::vector<VerificationProblem>& verification_problems()
{
    static const std::vector<VerificationProblem> all = {
        {"laws", "energies, stresses and tangents of each law agree and have their invariances", 1.0, 1.0, laws_rows},
        {"patch_test", "affine displacements are reproduced to rounding", 1.0, 1.0, patch_test_rows},
        {"manufactured_solution", "orders of convergence in L2 and H1", 3.0, 30.0, manufactured_solution_rows},
        {"own_weight", "a quadratic displacement is reproduced to rounding", 1.0, 1.0, own_weight_rows},
        {"cantilever", "bending against Timoshenko's beam", 5.0, 20.0, cantilever_rows},
        {"gravity_cantilever", "a soft bar under its own weight", 3.0, 3.0, gravity_cantilever_rows},
        {"torsion", "a square bar against Saint-Venant's series", 3.0, 30.0, torsion_rows},
        {"thick_sphere", "Lame's sphere under internal pressure, nu = 0.3 and 0.499", 3.0, 30.0, thick_sphere_rows},
        {"cooks_membrane", "Cook's membrane, plane strain and plane stress", 5.0, 6.0, cooks_membrane_rows},
        {"cooks_membrane_finite_strain", "Cook's membrane of an isochoric neo-Hookean law, large strains", 8.0, 60.0,
         cooks_membrane_finite_strain_rows},
        {"twisted_beam", "MacNeal and Harder's twisted beam, in and out of plane", 2.0, 10.0, twisted_beam_rows},
        {"half_turn", "Newton's iterations and states of a bar turned by 180 degrees, against another implementation", 10.0, 30.0,
         half_turn_rows},
        {"thick_plate", "NAFEMS LE10, stress at the edge of a hole", 4.0, 20.0, thick_plate_rows},
        {"locking", "bending and torsion as Poisson's ratio goes to 1/2, by element", 15.0, 60.0, locking_rows},
        {"pbs_locking", "the same bending under PBS: one volume constraint per tet", 5.0, 40.0, pbs_locking_rows},
        {"attached_limb",
         "properties of the limb that do not depend on its flesh; a fit that finds its own input; the cost of a further frame", 15.0, 15.0,
         attached_limb_rows},
        {"error_split", "the parts of an error compared with the whole; an error bar compared with a better solution", 20.0, 20.0,
         error_split_rows},
        {"grid_convergence", "the error bar's order and index on a published example", 1.0, 1.0, grid_convergence_rows},
        {"dynamics", "a vibrating cantilever: order in the time step, energy, damping, first frequency", 2.0, 8.0, dynamics_rows},
        {"moving_skeleton", "order in the time step where the skeleton moves the flesh, large strains", 2.0, 2.0, moving_skeleton_rows},
        {"calculix", "CalculiX has the same answer at every node; its time", 40.0, 120.0, calculix_rows},
        {"distributed", "multigrid and several processes agree with the direct solver at every node", 5.0, 5.0, distributed_rows},
    };
    return all;
}

}  // namespace experiments
