#include "reference_fem/laws/constitutive_law.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>

namespace reference_fem {
namespace {

// [a]x b = a x b
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a)
{
    Eigen::Matrix3d matrix;
    matrix << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
    return matrix;
}

// psi = mu eps:eps + lambda / 2 (tr eps)^2, eps = (F + F^T) / 2 - I.
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

// psi = mu |F - R|^2 + lambda / 2 (tr S - 3)^2, F = R S (E. Sifakis, J. Barbic, FEM Simulation of 3D Deformable Solids,
// SIGGRAPH 2012 courses, part I, section 3.4). Its derivatives by F: those through R vanish from the gradient, since
// R^T dR is skew and S symmetric.
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

// psi = mu / 2 (|F|^2 - 3) - mu (J - 1) + lambda' / 2 (J - 1)^2, J = det F, with lambda' = lambda + mu, without which
// the small-strain limit would have lambda - mu. Smith, de Goes, Kim 2018, without their term in ln(|F|^2 + 1): like
// HOBAK, the code of T. Kim, D. Eberle, Dynamic Deformables, SIGGRAPH 2020 courses, that leaves it out too. The price:
// the tet shrunk to a point, F = 0, is a local minimum. With the square completed, this is mu / 2 (|F|^2 - 3) + lambda'
// / 2 (J - 1 - mu / lambda')^2 of M. Macklin, M. Mueller, MIG 2021.
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
        response.shape_hessian =
            mu * (Tangent::Identity() + outer(response.dilatation_gradient, response.dilatation_gradient) +
                  (volume_change - 1.0) * response.dilatation_hessian);
        return response;
    }
};

// psi = mu / 2 (|F|^2 - 3) - mu ln J + lambda / 2 (ln J)^2, J = det F > 0 (Bonet, Wood, Eq. 6.27).
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

// psi = mu E:E + lambda / 2 (tr E)^2, E = (F^T F - I) / 2.
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
            for (int l = 0; l < 3; ++l)
                response.shape_hessian.block<3, 3>(3 * j, 3 * l).diagonal().array() += 2.0 * mu * strain(l, j);
        }
        response.dilatation_hessian.setIdentity();
        return response;
    }
};

// psi = kappa / 4 (J^2 - 1 - 2 ln J) + mu / 2 (J^(-2/3) |F|^2 - 3), kappa = lambda + 2 mu / 3, J = det F > 0: deal.II's
// step-44 and the program Quasi-Static Finite-Strain Compressible Elasticity of its code gallery, after J. Simo, T.
// Hughes, Computational Inelasticity.
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
        response.shape =
            0.25 * kappa * ((2.0 + volume_change) * volume_change - 2.0 * log_volume) +
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
        response.shape_hessian = volume_slope * cofactor_derivative(f) +
                                 volume_curvature * outer(volume_gradient, volume_gradient) +
                                 shear * (Tangent::Identity() - 2.0 / (3.0 * volume) * (mixed + mixed.transpose()));
        response.dilatation_hessian.setZero();
        return response;
    }
};

}  // namespace

Eigen::Matrix3d cofactor(const Eigen::Matrix3d& f)
{
    Eigen::Matrix3d result;
    for (int j = 0; j < 3; ++j) result.col(j) = f.col((j + 1) % 3).cross(f.col((j + 2) % 3));
    return result;
}

Tangent cofactor_derivative(const Eigen::Matrix3d& f)
{
    Tangent result = Tangent::Zero();
    for (int j = 0; j < 3; ++j) {  // column j is f_k x f_l
        const int k = (j + 1) % 3, l = (j + 2) % 3;
        result.block<3, 3>(3 * j, 3 * k) = -cross_matrix(f.col(l));
        result.block<3, 3>(3 * j, 3 * l) = cross_matrix(f.col(k));
    }
    return result;
}

Tangent transposing_product(const Eigen::Matrix3d& a)
{
    Tangent result;
    for (int j = 0; j < 3; ++j)
        for (int l = 0; l < 3; ++l) result.block<3, 3>(3 * j, 3 * l) = a.col(l) * a.col(j).transpose();
    return result;
}

double Invariants::log_volume() const
{
    return std::abs(volume_change) < 0.5 ? std::log1p(volume_change) : std::log(volume);
}

Invariants invariants(const Eigen::Matrix3d& f)
{
    const Eigen::Matrix3d g = f - Eigen::Matrix3d::Identity();
    double second = 0.0;  // of the principal invariants: the sum of the principal minors
    for (int i = 0, j = 1; i < 3; ++i, j = (j + 1) % 3) second += g(i, i) * g(j, j) - g(i, j) * g(j, i);
    const double trace = g.trace(), determinant = g.determinant(), squared_norm = g.squaredNorm();
    return {f.determinant(), trace + second + determinant, 2.0 * trace + squared_norm,
            0.5 * squared_norm - second - determinant};
}

PolarDecomposition polar_decomposition(const Eigen::Matrix3d& f)
{
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
    PolarDecomposition polar{svd.matrixU(), svd.matrixV(), svd.singularValues(), {}};
    polar.rotation.noalias() = polar.left * polar.right.transpose();
    if (polar.rotation.determinant() < 0.0) {
        polar.left.col(2) *= -1.0;
        polar.stretches(2) *= -1.0;
        polar.rotation.noalias() = polar.left * polar.right.transpose();
    }
    return polar;
}

Tangent rotation_derivative(const PolarDecomposition& polar)
{
    const double lowest_sum = 1e-8 * std::max(1.0, polar.stretches(0));
    Tangent derivative = Tangent::Zero();
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        const Eigen::Matrix3d twist =
            polar.left.col(j) * polar.right.col(i).transpose() - polar.left.col(i) * polar.right.col(j).transpose();
        const double sum = std::max(polar.stretches(i) + polar.stretches(j), lowest_sum);
        derivative += outer(twist, twist) / sum;
    }
    return derivative;
}

std::unique_ptr<const ConstitutiveLaw> constitutive_law(Model model, const Lame& lame)
{
    switch (model) {
        case Model::linear:
            return std::make_unique<Linear>(lame);
        case Model::corotational:
            return std::make_unique<Corotational>(lame);
        case Model::stable_neo_hookean:
            return std::make_unique<StableNeoHookean>(lame);
        case Model::neo_hookean:
            return std::make_unique<NeoHookean>(lame);
        case Model::st_venant_kirchhoff:
            return std::make_unique<StVenantKirchhoff>(lame);
        case Model::isochoric_neo_hookean:
            return std::make_unique<IsochoricNeoHookean>(lame);
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
