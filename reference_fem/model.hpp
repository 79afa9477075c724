// Constitutive laws by name; their definitions are in laws/.
#pragma once

namespace reference_fem {

// Isotropic all, with the same limit at small strain.
enum class Model {
    linear,                 // small strain: rotation by a is taken for a strain of 1 - cos(a)
    corotational,           // small strain in the frame of the polar decomposition F = R S
    stable_neo_hookean,     // B. Smith, F. de Goes, T. Kim, ACM TOG 37(2), 2018; defined and smooth through inversion
    neo_hookean,            // compressible: J. Bonet, R. Wood, Nonlinear Continuum Mechanics, Eq. 6.27; infinite at det F <= 0
    st_venant_kirchhoff,    // negative control: softens under compression and collapses
    isochoric_neo_hookean,  // split into det F and the isochoric part, the law of the finite-strain Cook's membrane benchmark
};

}  // namespace reference_fem
