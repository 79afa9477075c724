// psi = mu |F - R|^2 + lambda / 2 (tr S - 3)^2, F = R S (E. Sifakis, J. Barbic, FEM Simulation of 3D Deformable Solids, SIGGRAPH 2012
// courses, part I, section 3.4). Its derivatives by F: those through R vanish from the gradient, since R^T dR is skew and S symmetric.
#include "reference_fem/laws/isotropic_laws.hpp"
#include "reference_fem/laws/polar_decomposition.hpp"

namespace reference_fem {
namespace {

class Corotational : public ConstitutiveLaw {
public:
    using ConstitutiveLaw::ConstitutiveLaw;

    PointResponse evaluate(const Eigen::Matrix3d& f, Derivatives derivatives) const override
    {
        PointResponse response;
        response.defined = f.allFinite();
        if (!response.defined) return response;

        const PolarDecomposition polar = polar_decomposition(f);
        response.shape = lame_.mu_pa * (f - polar.rotation).squaredNorm();
        response.dilatation = polar.stretches.sum() - 3.0;
        if (derivatives == Derivatives::none) return response;

        response.shape_gradient = 2.0 * lame_.mu_pa * (f - polar.rotation);
        response.dilatation_gradient = polar.rotation;
        if (derivatives == Derivatives::first) return response;

        response.dilatation_hessian = rotation_derivative(polar);
        response.shape_hessian = 2.0 * lame_.mu_pa * (Tangent::Identity() - response.dilatation_hessian);
        return response;
    }
};

}  // namespace

std::unique_ptr<const ConstitutiveLaw> corotational_law(const Lame& lame)
{
    return std::make_unique<Corotational>(lame);
}

}  // namespace reference_fem
