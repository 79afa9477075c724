#include "pbs/flesh/flesh_energy.hpp"

#include "pbs/geometry/input_error.hpp"

#include <string>

namespace pbs {

FleshMaterial flesh_material(double poisson)
{
    if (!(poisson >= 0.0 && poisson < 0.5)) throw InputError("flesh", 0, "poisson", std::to_string(poisson), "expected 0 <= poisson < 1/2");
    const double mu = 1.0 / (2.0 * (1.0 + poisson));
    const double lame = poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    const double lambda = lame + mu;
    return {mu, lambda, 1.0 + mu / lambda};
}

}  // namespace pbs
