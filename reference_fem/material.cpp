#include "reference_fem/material.hpp"

#include "reference_fem/input_checks.hpp"

namespace reference_fem {

Lame lame_parameters(double young_pa, double poisson)
{
    require(young_pa > 0.0 && std::isfinite(young_pa), "young_pa", young_pa, "expected young_pa > 0");
    require(poisson > -1.0 && poisson < 0.5, "poisson", poisson, "expected -1 < poisson < 0.5");
    return {young_pa * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), young_pa / (2.0 * (1.0 + poisson))};
}

}  // namespace reference_fem
