// psi = mu eps:eps + lambda / 2 (tr eps)^2, eps = (F + F^T) / 2 - I.
#include "reference_fem/laws/isotropic_laws.hpp"
#include "reference_fem/laws/matrix_calculus.hpp"

namespace reference_fem {
namespace {

class Linear : public ConstitutiveLaw {
public:
    using ConstitutiveLaw::ConstitutiveLaw;

    PointResponse evaluate(const Eigen::Matrix3d& f, Derivatives derivatives) const override
    {
        const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
        const Eigen::Matrix3d strain = 0.5 * (f + f.transpose()) - identity;
        PointResponse response;
        response.shape = lame_.mu_pa * strain.squaredNorm();
        response.dilatation = strain.trace();
        if (derivatives == Derivatives::none) return response;

        response.shape_gradient = 2.0 * lame_.mu_pa * strain;
        response.dilatation_gradient = identity;
        if (derivatives == Derivatives::first) return response;

        response.shape_hessian = lame_.mu_pa * (Tangent::Identity() + transposing_product(identity));
        response.dilatation_hessian.setZero();
        return response;
    }
};

}  // namespace

std::unique_ptr<const ConstitutiveLaw> linear_law(const Lame& lame)
{
    return std::make_unique<Linear>(lame);
}

}  // namespace reference_fem
