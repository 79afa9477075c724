// Constitutive laws at a point, for tests: energy, stress and tangent in one call each, and deformation gradients at
// which they are tested.
#pragma once

#include "reference_fem/laws/constitutive_law.hpp"
#include "tests/support/random_points.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace test_support {

using reference_fem::Derivatives;
using reference_fem::Model;

struct NamedModel {
    Model model;
    std::string name;
    bool through_inversion;  // true if defined at det F <= 0
};

inline const std::vector<NamedModel> all_models = {{Model::corotational, "corotational", true},
                                                   {Model::stable_neo_hookean, "stable_neo_hookean", true},
                                                   {Model::neo_hookean, "neo_hookean", false},
                                                   {Model::st_venant_kirchhoff, "st_venant_kirchhoff", true},
                                                   {Model::isochoric_neo_hookean, "isochoric_neo_hookean", false},
                                                   {Model::linear, "linear", true}};
inline const std::vector<NamedModel> nonlinear_models(all_models.begin(), all_models.end() - 1);

inline void PrintTo(const NamedModel& model, std::ostream* stream)
{
    *stream << model.name;
}
inline std::string name_of_model(const testing::TestParamInfo<NamedModel>& info)
{
    return info.param.name;
}

struct LawPoint {
    std::unique_ptr<const reference_fem::ConstitutiveLaw> law;

    LawPoint(Model model, const reference_fem::Lame& lame) : law(constitutive_law(model, lame)) {}

    double energy(const Eigen::Matrix3d& f) const
    {
        return energy_density(law->evaluate(f, Derivatives::none), law->lambda_pa());
    }
    Eigen::Matrix3d stress(const Eigen::Matrix3d& f) const
    {
        return first_piola_kirchhoff(law->evaluate(f, Derivatives::first), law->lambda_pa());
    }
    reference_fem::Tangent tangent(const Eigen::Matrix3d& f) const
    {
        return reference_fem::tangent(law->evaluate(f, Derivatives::second), law->lambda_pa());
    }
};

inline bool all_finite(const reference_fem::PointResponse& response)
{
    return std::isfinite(response.shape) && std::isfinite(response.dilatation) && response.shape_gradient.allFinite() &&
           response.dilatation_gradient.allFinite() && response.shape_hessian.allFinite() &&
           response.dilatation_hessian.allFinite();
}

inline Eigen::Matrix3d diagonal(double a, double b, double c)
{
    return Eigen::Vector3d(a, b, c).asDiagonal();
}

inline Eigen::Matrix3d random_matrix(RandomPoints& random, double size)
{
    Eigen::Matrix3d matrix;
    for (int j = 0; j < 3; ++j) matrix.col(j) = random.point(size);
    return matrix;
}

inline Eigen::Matrix3d random_rotation(RandomPoints& random)
{
    return random.rigid_motion(0.0).linear();
}

// Any rotation and principal axes, with stretches from 0.6 to 1.6.
inline Eigen::Matrix3d random_stretch(RandomPoints& random)
{
    const Eigen::Vector3d stretches(random.number(0.6, 1.6), random.number(0.6, 1.6), random.number(0.6, 1.6));
    return random_rotation(random) * stretches.asDiagonal() * random_rotation(random);
}

// The same, inverted: det F < 0, and no two signed stretches have a sum near 0.
inline Eigen::Matrix3d random_inversion(RandomPoints& random)
{
    const Eigen::Vector3d stretches(random.number(1.2, 1.6), random.number(0.9, 1.2), -random.number(0.3, 0.6));
    return random_rotation(random) * stretches.asDiagonal() * random_rotation(random);
}

}  // namespace test_support
