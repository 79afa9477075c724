// psi = mu / 2 (|F|^2 - 3) - mu ln J + lambda / 2 (ln J)^2, J = det F > 0 (Bonet, Wood, Eq. 6.27).
#include "reference_fem/laws/isotropic_laws.hpp"
#include "reference_fem/laws/matrix_calculus.hpp"

namespace reference_fem {
namespace {

class NeoHookean : public ConstitutiveLaw {
public:
    using ConstitutiveLaw::ConstitutiveLaw;

    PointResponse evaluate(const Eigen::Matrix3d& f, Derivatives derivatives) const override
    {
        const Invariants change = invariants(f);
        const double mu = lame_.mu_pa, volume_change = change.volume_change;
        PointResponse response;
        response.defined = change.volume > 0.0;
        if (!response.defined) return response;

        const double log_volume = change.log_volume();
        response.shape = mu * (change.shear + volume_change - log_volume);
        response.dilatation = log_volume;
        if (derivatives == Derivatives::none) return response;

        const Eigen::Matrix3d inverse_transposed = cofactor(f) / change.volume;
        response.dilatation_gradient = inverse_transposed;
        response.shape_gradient = mu * (f - inverse_transposed);
        if (derivatives == Derivatives::first) return response;

        response.dilatation_hessian = -transposing_product(inverse_transposed);
        response.shape_hessian = mu * (Tangent::Identity() - response.dilatation_hessian);
        return response;
    }
};

}  // namespace

std::unique_ptr<const ConstitutiveLaw> neo_hookean_law(const Lame& lame)
{
    return std::make_unique<NeoHookean>(lame);
}

}  // namespace reference_fem
