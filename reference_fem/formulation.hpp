// How the change of volume enters the elements.
#pragma once

namespace reference_fem {

// All three for the linear law (linear_flesh.hpp), the first two for any (potentials/elastic_potential.hpp).
enum class Formulation {
    displacement,     // theta at every quadrature point: locks as nu goes to 1/2
    mean_dilatation,  // theta's mean over each tet, one volume constraint a tet; on P2 the P2-P0 element
    taylor_hood,      // P2 with a continuous P1 pressure
};

}  // namespace reference_fem
