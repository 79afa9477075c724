// Isotropic linear elasticity: stress = lambda tr(eps) I + 2 mu eps.
#pragma once

namespace reference_fem {

// Lame's parameters; lambda < 0 where nu < 0.
struct Lame {
    double lambda_pa = 0.0;  // E nu / ((1 + nu) (1 - 2 nu))
    double mu_pa = 0.0;      // E / (2 (1 + nu))
};

// young_pa > 0 and -1 < poisson < 0.5, else pbs::InputError.
Lame lame_parameters(double young_pa, double poisson);

}  // namespace reference_fem
