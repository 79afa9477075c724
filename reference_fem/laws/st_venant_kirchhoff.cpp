// psi = mu E:E + lambda / 2 (tr E)^2, E = (F^T F - I) / 2.
#include "reference_fem/laws/isotropic_laws.hpp"
#include "reference_fem/laws/matrix_calculus.hpp"

namespace reference_fem {
namespace {

class StVenantKirchhoff : public ConstitutiveLaw {
public:
    using ConstitutiveLaw::ConstitutiveLaw;

    PointResponse evaluate(const Eigen::Matrix3d& f, Derivatives derivatives) const override
    {
        const double mu = lame_.mu_pa;
        const Eigen::Matrix3d strain = 0.5 * (f.transpose() * f - Eigen::Matrix3d::Identity());
        PointResponse response;
        response.shape = mu * strain.squaredNorm();
        response.dilatation = strain.trace();
        if (derivatives == Derivatives::none) return response;

        response.shape_gradient.noalias() = 2.0 * mu * f * strain;
        response.dilatation_gradient = f;
        if (derivatives == Derivatives::first) return response;

        // dP = 2 mu (dF E + F dE), dE = (F^T dF + dF^T F) / 2
        response.shape_hessian = mu * transposing_product(f);
        const Eigen::Matrix3d left_cauchy_green = f * f.transpose();
        for (int j = 0; j < 3; ++j) {
            response.shape_hessian.block<3, 3>(3 * j, 3 * j) += mu * left_cauchy_green;
            for (int l = 0; l < 3; ++l) response.shape_hessian.block<3, 3>(3 * j, 3 * l).diagonal().array() += 2.0 * mu * strain(l, j);
        }
        response.dilatation_hessian.setIdentity();
        return response;
    }
};

}  // namespace

std::unique_ptr<const ConstitutiveLaw> st_venant_kirchhoff_law(const Lame& lame)
{
    return std::make_unique<StVenantKirchhoff>(lame);
}

}  // namespace reference_fem
