// How flesh answers a deformation gradient F: energy density, stress and tangent of an isotropic law.
//   const auto law = constitutive_law(Model::stable_neo_hookean, lame_parameters(young_pa, poisson));
//   const PointResponse response = law->evaluate(F, Derivatives::second);
//   first_piola_kirchhoff(response, law->lambda_pa());
// Every law is written in two parts, psi(F) = shape(F) + lambda / 2 theta(F)^2, where the dilatation theta is the law's own measure of
// the change of volume. The mean dilatation formulation then replaces theta by its mean over the tet, for each law alike.
// All have the small-strain limit of linear elasticity with the same Lame parameters.
#pragma once

#include "reference_fem/options.hpp"

#include "pbs/geometry/tet_mesh.hpp"

#include <Eigen/Core>

#include <memory>

namespace reference_fem {

using Tangent = Eigen::Matrix<double, 9, 9>;  // d vec(A) / d vec(F), vec by columns

// By F, of the energy density: none asks for psi alone, second for all.
enum class Derivatives { none, first, second };

// The requested quantities: shape [Pa], theta [1], and their derivatives by F; the rest is left as it is.
struct PointResponse {
    bool defined = true;                                  // false: F is outside the law's domain (det F <= 0), nothing else is set
    double shape = 0.0, dilatation = 0.0;                 // [Pa], [1]
    Eigen::Matrix3d shape_gradient, dilatation_gradient;  // d shape / d F [Pa], d theta / d F [1]
    Tangent shape_hessian, dilatation_hessian;            // [Pa], [1]; symmetric
};

// A law has no state except its parameters.
class ConstitutiveLaw {
public:
    explicit ConstitutiveLaw(const Lame& lame) : lame_(lame) {}  // not checked: lame_parameters has
    virtual ~ConstitutiveLaw() = default;

    // At any F, 3 x 3; nothing is thrown: `defined` says where the law has no value.
    virtual PointResponse evaluate(const Eigen::Matrix3d& deformation_gradient, Derivatives derivatives) const = 0;

    double lambda_pa() const { return volume_term() ? lame_.lambda_pa : 0.0; }  // the factor of theta^2 / 2
    virtual bool volume_term() const { return true; }                           // false: the law is not of the two-part form, theta = 0

protected:
    Lame lame_;  // as given
};

// Makes a law by name; the formulas are in constitutive_law.cpp.
std::unique_ptr<const ConstitutiveLaw> constitutive_law(Model model, const Lame& lame);

// psi [Pa] of a response; lambda_pa: its law's lambda_pa().
double energy_density(const PointResponse& response, double lambda_pa);
Eigen::Matrix3d first_piola_kirchhoff(const PointResponse& response, double lambda_pa);  // P = d psi / d F [Pa], from a first derivative on
Tangent tangent(const PointResponse& response, double lambda_pa);                        // d vec P / d vec F [Pa], from a second derivative

}  // namespace reference_fem
