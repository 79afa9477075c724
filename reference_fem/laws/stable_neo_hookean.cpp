// psi = mu / 2 (|F|^2 - 3) - mu (J - 1) + lambda' / 2 (J - 1)^2, J = det F, with lambda' = lambda + mu, without which the small-strain
// limit would have lambda - mu. Smith, de Goes, Kim 2018, without their term in ln(|F|^2 + 1): like HOBAK, the code of T. Kim, D. Eberle,
// Dynamic Deformables, SIGGRAPH 2020 courses, that leaves it out too. The price: the tet shrunk to a point, F = 0, is a local minimum.
// With the square completed, this is mu / 2 (|F|^2 - 3) + lambda' / 2 (J - 1 - mu / lambda')^2 of M. Macklin, M. Mueller, MIG 2021.
#include "reference_fem/laws/isotropic_laws.hpp"
#include "reference_fem/laws/matrix_calculus.hpp"

namespace reference_fem {
namespace {

class StableNeoHookean : public ConstitutiveLaw {
public:
    using ConstitutiveLaw::ConstitutiveLaw;

    PointResponse evaluate(const Eigen::Matrix3d& f, Derivatives derivatives) const override
    {
        const Invariants change = invariants(f);
        const double mu = lame_.mu_pa, volume_change = change.volume_change;
        PointResponse response;
        response.shape = mu * (change.shear + 0.5 * volume_change * volume_change);
        response.dilatation = volume_change;
        if (derivatives == Derivatives::none) return response;

        response.dilatation_gradient = cofactor(f);
        response.shape_gradient = mu * (f + (volume_change - 1.0) * response.dilatation_gradient);
        if (derivatives == Derivatives::first) return response;

        response.dilatation_hessian = cofactor_derivative(f);
        response.shape_hessian = mu * (Tangent::Identity() + outer(response.dilatation_gradient, response.dilatation_gradient) +
                                       (volume_change - 1.0) * response.dilatation_hessian);
        return response;
    }
};

}  // namespace

std::unique_ptr<const ConstitutiveLaw> stable_neo_hookean_law(const Lame& lame)
{
    return std::make_unique<StableNeoHookean>(lame);
}

}  // namespace reference_fem
