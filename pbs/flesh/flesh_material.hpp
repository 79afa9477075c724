// The material of the flesh: neo-Hookean without logarithm (M. Macklin, M. Mueller, A constraint-based formulation of stable neo-Hookean
// materials, MIG 2021),
//   psi(F) = mu / 2 (|F|^2 - 3) + lambda / 2 (J - alpha)^2,   J = det F,   alpha = 1 + mu / lambda.
// With these constants it has Poisson's ratio at small strains, and equals stable_neo_hookean_law of the reference up to a constant. The
// energy is finite for every F, so that inverted tets need no exception. It is relative to Young's modulus, which no shape depends on,
// because the springs of the bones are relative to it, too.
#pragma once

namespace pbs {

struct FleshMaterial {
    double mu = 0.0, lambda = 0.0;  // over Young's modulus
    double alpha = 1.0;             // the J at which the volume term is zero
};

// poisson: from 0 inclusive to 1/2 exclusive; an InputError otherwise.
FleshMaterial flesh_material(double poisson);

}  // namespace pbs
