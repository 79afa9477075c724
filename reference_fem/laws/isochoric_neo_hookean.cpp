// psi = kappa / 4 (J^2 - 1 - 2 ln J) + mu / 2 (J^(-2/3) |F|^2 - 3), kappa = lambda + 2 mu / 3, J = det F > 0: deal.II's step-44 and the
// program Quasi-Static Finite-Strain Compressible Elasticity of its code gallery, after J. Simo, T. Hughes, Computational Inelasticity.
#include "reference_fem/laws/isotropic_laws.hpp"
#include "reference_fem/laws/matrix_calculus.hpp"

#include <cmath>

namespace reference_fem {
namespace {

class IsochoricNeoHookean : public ConstitutiveLaw {
public:
    using ConstitutiveLaw::ConstitutiveLaw;

    bool volume_term() const override { return false; }

    PointResponse evaluate(const Eigen::Matrix3d& f, Derivatives derivatives) const override
    {
        const Invariants change = invariants(f);
        const double volume_change = change.volume_change;
        PointResponse response;
        response.defined = change.volume > 0.0;
        if (!response.defined) return response;

        const double mu = lame_.mu_pa, kappa = lame_.lambda_pa + 2.0 / 3.0 * mu, log_volume = change.log_volume();
        const double isochoric = std::exp(-2.0 / 3.0 * log_volume);
        response.shape = 0.25 * kappa * ((2.0 + volume_change) * volume_change - 2.0 * log_volume) +
                         0.5 * mu * (3.0 * std::expm1(-2.0 / 3.0 * log_volume) + isochoric * change.squared_norm_change);
        response.dilatation = 0.0;
        if (derivatives == Derivatives::none) return response;

        const double volume = change.volume, first_invariant = f.squaredNorm();
        const Eigen::Matrix3d volume_gradient = cofactor(f);
        // P = volume_slope d J / d F + mu J^(-2/3) F
        const double shear = mu * isochoric,
                     volume_slope = 0.5 * kappa * (volume - 1.0 / volume) - shear * first_invariant / (3.0 * volume);
        response.shape_gradient = volume_slope * volume_gradient + shear * f;
        response.dilatation_gradient.setZero();
        if (derivatives == Derivatives::first) return response;

        const double volume_curvature =
            0.5 * kappa * (1.0 + 1.0 / (volume * volume)) + shear * 5.0 / 9.0 * first_invariant / (volume * volume);
        const Tangent mixed = outer(volume_gradient, f);
        response.shape_hessian = volume_slope * cofactor_derivative(f) + volume_curvature * outer(volume_gradient, volume_gradient) +
                                 shear * (Tangent::Identity() - 2.0 / (3.0 * volume) * (mixed + mixed.transpose()));
        response.dilatation_hessian.setZero();
        return response;
    }
};

}  // namespace

std::unique_ptr<const ConstitutiveLaw> isochoric_neo_hookean_law(const Lame& lame)
{
    return std::make_unique<IsochoricNeoHookean>(lame);
}

}  // namespace reference_fem
