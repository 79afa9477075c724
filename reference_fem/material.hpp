// Isotropic linear elasticity: stress = lambda tr(eps) I + 2 mu eps.
#pragma once

namespace reference_fem {

struct Lame {
    double lambda_pa = 0.0;
    double mu_pa = 0.0;
};

// young_pa > 0 and -1 < poisson < 0.5, else pbs::InputError.
Lame lame_parameters(double young_pa, double poisson);

}  // namespace reference_fem
