// Choices that several parts of the reference have in common: formulation, law, scheme in time and linear solver. Also
// Lame's parameters and the checks of meshes and of single values.
#pragma once

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <sstream>

namespace reference_fem {

// How the change of volume enters the elements: all three for the linear law (linear_flesh.hpp), the first two for any
// (potentials/potentials.hpp).
enum class Formulation {
    displacement,     // theta at every quadrature point: locks as nu goes to 1/2
    mean_dilatation,  // theta's mean over each tet, one volume constraint per tet; on P2 the P2-P0 element
    taylor_hood,      // P2 with a continuous P1 pressure
};

// Constitutive laws by name; their definitions are in laws/.
// All laws are isotropic and have the same limit at small strain.
enum class Model {
    linear,              // small strain: a rotation by a produces a fictitious strain of 1 - cos(a)
    corotational,        // small strain in the frame of the polar decomposition F = R S
    stable_neo_hookean,  // B. Smith, F. de Goes, T. Kim, ACM TOG 37(2), 2018, without their term in ln(|F|^2 + 1);
                         // defined and smooth through inversion. With the square completed it is the energy of M.
                         // Macklin, M. Mueller, A Constraint-based Formulation of Stable Neo-Hookean Materials, MIG
                         // 2021
    neo_hookean,  // compressible: J. Bonet, R. Wood, Nonlinear Continuum Mechanics, Eq. 6.27; infinite at det F <= 0
    st_venant_kirchhoff,    // negative control: softens under compression and collapses
    isochoric_neo_hookean,  // split into det F and the isochoric part, the law of the finite-strain Cook's membrane
                            // benchmark
};

// Isotropic linear elasticity: stress = lambda tr(eps) I + 2 mu eps.
// Lame's parameters; lambda < 0 where nu < 0.
struct Lame {
    double lambda_pa = 0.0;  // E nu / ((1 + nu) (1 - 2 nu))
    double mu_pa = 0.0;      // E / (2 (1 + nu))
};

// young_pa > 0 and -1 < poisson < 0.5, else pbs::InputError.
Lame lame_parameters(double young_pa, double poisson);

// How a body moves in time.
// The schemes in time are those of dynamics/time_stepper.hpp.
enum class Dynamics {
    quasi_static,       // equilibrium in every pose
    newmark,            // average acceleration: beta 1/4, gamma 1/2
    generalized_alpha,  // J. Chung, G. Hulbert, J. Appl. Mech. 60, 1993
};

// The sparse solver of K u = f, both of SuiteSparse. linear_solvers.hpp describes each of them; cholmod is the default
// everywhere.
enum class LinearSolver { cholmod, umfpack };

// Checks of the reference solver's input. Each violation is a pbs::InputError that names the field, the value and the
// rule. Throws unless it holds; without file and line, since the input is arrays.
template <typename Value>
void require(bool holds, const char* field, const Value& value, const char* rule)
{
    if (holds) return;
    std::ostringstream text;
    text << value;
    throw pbs::InputError("", 0, field, text.str(), rule);
}

// Finite points, vertex indices in range, every tet of positive volume, every vertex used.
void check_mesh(const pbs::TetMesh& mesh);

}  // namespace reference_fem
