#include "reference_fem/laws/constitutive_law.hpp"

#include "reference_fem/laws/isotropic_laws.hpp"
#include "reference_fem/laws/matrix_calculus.hpp"

namespace reference_fem {

std::unique_ptr<const ConstitutiveLaw> constitutive_law(Model model, const Lame& lame)
{
    switch (model) {
        case Model::linear:
            return linear_law(lame);
        case Model::corotational:
            return corotational_law(lame);
        case Model::stable_neo_hookean:
            return stable_neo_hookean_law(lame);
        case Model::neo_hookean:
            return neo_hookean_law(lame);
        case Model::st_venant_kirchhoff:
            return st_venant_kirchhoff_law(lame);
        case Model::isochoric_neo_hookean:
            return isochoric_neo_hookean_law(lame);
    }
    return nullptr;
}

double energy_density(const PointResponse& response, double lambda_pa)
{
    return response.shape + 0.5 * lambda_pa * response.dilatation * response.dilatation;
}

Eigen::Matrix3d first_piola_kirchhoff(const PointResponse& response, double lambda_pa)
{
    return response.shape_gradient + lambda_pa * response.dilatation * response.dilatation_gradient;
}

Tangent tangent(const PointResponse& response, double lambda_pa)
{
    return response.shape_hessian + lambda_pa * (outer(response.dilatation_gradient, response.dilatation_gradient) +
                                                 response.dilatation * response.dilatation_hessian);
}

}  // namespace reference_fem
