// Constitutive laws by name; their definitions are in laws/.
#pragma once

namespace reference_fem {

// All laws are isotropic and have the same limit at small strain.
enum class Model {
    linear,                 // small strain: a rotation by a produces a fictitious strain of 1 - cos(a)
    corotational,           // small strain in the frame of the polar decomposition F = R S
    stable_neo_hookean,     // B. Smith, F. de Goes, T. Kim, ACM TOG 37(2), 2018, without their term in ln(|F|^2 + 1); defined and smooth
                            // through inversion. With the square completed it is the energy of M. Macklin, M. Mueller, A
                            // Constraint-based Formulation of Stable Neo-Hookean Materials, MIG 2021
    neo_hookean,            // compressible: J. Bonet, R. Wood, Nonlinear Continuum Mechanics, Eq. 6.27; infinite at det F <= 0
    st_venant_kirchhoff,    // negative control: softens under compression and collapses
    isochoric_neo_hookean,  // split into det F and the isochoric part, the law of the finite-strain Cook's membrane benchmark
};

}  // namespace reference_fem
